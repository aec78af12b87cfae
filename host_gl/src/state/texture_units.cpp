// SPDX-License-Identifier: MIT
// Everything that is selected by glActiveTexture: enables, environment, generation, matrices, bindings, samplers; and
// the image units.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "state/writer.hpp"

namespace sluice::host::state {
namespace {

/// Puts glActiveTexture back.
class ActiveTextureGuard {
  public:
    ActiveTextureGuard() : active_(queryInteger(GL_ACTIVE_TEXTURE)) {}
    ActiveTextureGuard(const ActiveTextureGuard&) = delete;
    ActiveTextureGuard& operator=(const ActiveTextureGuard&) = delete;
    ~ActiveTextureGuard() { glActiveTexture(static_cast<GLenum>(active_)); }

  private:
    GLint active_;
};

struct Row {
    const char* name;
    GLenum pname;
    Since since{};
};

constexpr std::array kBindings{
    Row{"GL_TEXTURE_BINDING_1D", GL_TEXTURE_BINDING_1D},
    Row{"GL_TEXTURE_BINDING_2D", GL_TEXTURE_BINDING_2D},
    Row{"GL_TEXTURE_BINDING_3D", GL_TEXTURE_BINDING_3D},
    Row{"GL_TEXTURE_BINDING_CUBE_MAP", GL_TEXTURE_BINDING_CUBE_MAP},
    Row{"GL_TEXTURE_BINDING_RECTANGLE", GL_TEXTURE_BINDING_RECTANGLE, {31, "GL_ARB_texture_rectangle"}},
    Row{"GL_TEXTURE_BINDING_1D_ARRAY", GL_TEXTURE_BINDING_1D_ARRAY, {30, "GL_EXT_texture_array"}},
    Row{"GL_TEXTURE_BINDING_2D_ARRAY", GL_TEXTURE_BINDING_2D_ARRAY, {30, "GL_EXT_texture_array"}},
    Row{"GL_TEXTURE_BINDING_BUFFER", GL_TEXTURE_BINDING_BUFFER, {31, nullptr}},
    Row{"GL_TEXTURE_BINDING_2D_MULTISAMPLE", GL_TEXTURE_BINDING_2D_MULTISAMPLE, {32, "GL_ARB_texture_multisample"}},
    Row{"GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY",
        GL_TEXTURE_BINDING_2D_MULTISAMPLE_ARRAY,
        {32, "GL_ARB_texture_multisample"}},
    Row{"GL_TEXTURE_BINDING_CUBE_MAP_ARRAY", GL_TEXTURE_BINDING_CUBE_MAP_ARRAY, {40, "GL_ARB_texture_cube_map_array"}},
    Row{"GL_SAMPLER_BINDING", GL_SAMPLER_BINDING, {33, "GL_ARB_sampler_objects"}},
};

constexpr std::array kEnables{
    Row{"GL_TEXTURE_1D", GL_TEXTURE_1D},
    Row{"GL_TEXTURE_2D", GL_TEXTURE_2D},
    Row{"GL_TEXTURE_3D", GL_TEXTURE_3D},
    Row{"GL_TEXTURE_CUBE_MAP", GL_TEXTURE_CUBE_MAP},
    Row{"GL_TEXTURE_RECTANGLE", GL_TEXTURE_RECTANGLE, {31, "GL_ARB_texture_rectangle"}},
};

constexpr std::array kEnvironment{
    Row{"GL_TEXTURE_ENV_MODE", GL_TEXTURE_ENV_MODE},
    Row{"GL_COMBINE_RGB", GL_COMBINE_RGB},
    Row{"GL_COMBINE_ALPHA", GL_COMBINE_ALPHA},
    Row{"GL_SRC0_RGB", GL_SRC0_RGB},
    Row{"GL_SRC1_RGB", GL_SRC1_RGB},
    Row{"GL_SRC2_RGB", GL_SRC2_RGB},
    Row{"GL_SRC0_ALPHA", GL_SRC0_ALPHA},
    Row{"GL_SRC1_ALPHA", GL_SRC1_ALPHA},
    Row{"GL_SRC2_ALPHA", GL_SRC2_ALPHA},
    Row{"GL_OPERAND0_RGB", GL_OPERAND0_RGB},
    Row{"GL_OPERAND1_RGB", GL_OPERAND1_RGB},
    Row{"GL_OPERAND2_RGB", GL_OPERAND2_RGB},
    Row{"GL_OPERAND0_ALPHA", GL_OPERAND0_ALPHA},
    Row{"GL_OPERAND1_ALPHA", GL_OPERAND1_ALPHA},
    Row{"GL_OPERAND2_ALPHA", GL_OPERAND2_ALPHA},
};

void writeEnvironment(Writer& writer, const std::string& unit) {
    for (const Row& row : kEnvironment) {
        GLint value = 0;
        glGetTexEnviv(GL_TEXTURE_ENV, row.pname, &value);
        writer.put(member(unit, row.name), integersText(&value, 1, Kind::Enumerant));
    }
    for (const Row& row : {Row{"GL_RGB_SCALE", GL_RGB_SCALE}, Row{"GL_ALPHA_SCALE", GL_ALPHA_SCALE}}) {
        GLfloat value = 0.0F;
        glGetTexEnvfv(GL_TEXTURE_ENV, row.pname, &value);
        writer.put(member(unit, row.name), floatsText(&value, 1));
    }
    std::array<GLfloat, 4> colour{};
    glGetTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, colour.data());
    writer.put(member(unit, "GL_TEXTURE_ENV_COLOR"), floatsText(colour.data(), 4));
    GLfloat bias = 0.0F;
    glGetTexEnvfv(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_LOD_BIAS, &bias);
    writer.put(member(unit, "GL_TEXTURE_LOD_BIAS"), floatsText(&bias, 1));
    GLint replace = 0;
    glGetTexEnviv(GL_POINT_SPRITE, GL_COORD_REPLACE, &replace);
    writer.put(member(unit, "GL_COORD_REPLACE"), integersText(&replace, 1, Kind::Integer));
}

void writeGeneration(Writer& writer, const std::string& unit) {
    struct Coordinate {
        const char* name;
        GLenum coordinate;
        GLenum enable;
    };
    static constexpr std::array kCoordinates{
        Coordinate{"GL_TEXTURE_GEN_S", GL_S, GL_TEXTURE_GEN_S}, Coordinate{"GL_TEXTURE_GEN_T", GL_T, GL_TEXTURE_GEN_T},
        Coordinate{"GL_TEXTURE_GEN_R", GL_R, GL_TEXTURE_GEN_R}, Coordinate{"GL_TEXTURE_GEN_Q", GL_Q, GL_TEXTURE_GEN_Q}};
    for (const Coordinate& row : kCoordinates) {
        const std::string name = member(unit, row.name);
        writer.query(name, row.enable, Kind::Flag);
        GLint mode = 0;
        glGetTexGeniv(row.coordinate, GL_TEXTURE_GEN_MODE, &mode);
        writer.put(member(name, "mode"), integersText(&mode, 1, Kind::Enumerant));
        std::array<GLfloat, 4> plane{};
        glGetTexGenfv(row.coordinate, GL_OBJECT_PLANE, plane.data());
        writer.put(member(name, "object plane"), floatsText(plane.data(), 4));
        glGetTexGenfv(row.coordinate, GL_EYE_PLANE, plane.data());
        writer.put(member(name, "eye plane"), floatsText(plane.data(), 4));
    }
}

void writeImageUnits(Writer& writer) {
    if (!available({42, "GL_ARB_shader_image_load_store"})) {
        return;
    }
    static constexpr std::array kImage{
        Row{"GL_IMAGE_BINDING_NAME", GL_IMAGE_BINDING_NAME},
        Row{"GL_IMAGE_BINDING_LEVEL", GL_IMAGE_BINDING_LEVEL},
        Row{"GL_IMAGE_BINDING_LAYERED", GL_IMAGE_BINDING_LAYERED},
        Row{"GL_IMAGE_BINDING_LAYER", GL_IMAGE_BINDING_LAYER},
        Row{"GL_IMAGE_BINDING_ACCESS", GL_IMAGE_BINDING_ACCESS},
        Row{"GL_IMAGE_BINDING_FORMAT", GL_IMAGE_BINDING_FORMAT},
    };
    const int units = queryInteger(GL_MAX_IMAGE_UNITS);
    for (int i = 0; i < units; ++i) {
        for (const Row& row : kImage) {
            GLint value = 0;
            glGetIntegeri_v(row.pname, static_cast<GLuint>(i), &value);
            writer.put(member(numbered("image unit ", i), row.name), integersText(&value, 1, Kind::Integer));
        }
    }
}

}  // namespace

void writeTextureUnits(Writer& writer) {
    const ActiveTextureGuard guard;
    // Three counts: fixed-function units, texture coordinate sets, and units that any shader stage can bind.
    const int fixed = queryInteger(GL_MAX_TEXTURE_UNITS);
    const int coordinates = std::max(fixed, queryInteger(GL_MAX_TEXTURE_COORDS));
    const int all = std::max(coordinates, queryInteger(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS));
    for (int i = 0; i < all; ++i) {
        const std::string unit = numbered("unit ", i);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        for (const Row& row : kBindings) {
            if (available(row.since)) {
                writer.query(member(unit, row.name), row.pname, Kind::Integer);
            }
        }
        if (i < fixed) {
            for (const Row& row : kEnables) {
                if (available(row.since)) {
                    writer.query(member(unit, row.name), row.pname, Kind::Flag);
                }
            }
            writeEnvironment(writer, unit);
        }
        if (i < coordinates) {
            writeGeneration(writer, unit);
            writer.query(member(unit, "GL_TEXTURE_MATRIX"), GL_TEXTURE_MATRIX, Kind::Float, 16);
            writer.query(member(unit, "GL_TEXTURE_STACK_DEPTH"), GL_TEXTURE_STACK_DEPTH, Kind::Integer);
            writer.query(member(unit, "GL_CURRENT_TEXTURE_COORDS"), GL_CURRENT_TEXTURE_COORDS, Kind::Float, 4);
            writer.query(member(unit, "GL_CURRENT_RASTER_TEXTURE_COORDS"), GL_CURRENT_RASTER_TEXTURE_COORDS,
                         Kind::Float, 4);
        }
    }
    writeImageUnits(writer);
}

}  // namespace sluice::host::state
