// SPDX-License-Identifier: MIT
// Lights, materials, clip planes, matrices, pixel maps and the polygon stipple.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "screen/gl_guards.hpp"
#include "state/writer.hpp"

namespace sluice::host::state {
namespace {

struct Vector {
    const char* name;
    GLenum pname;
    int count;
};

void writeLights(Writer& writer) {
    static constexpr std::array kRows{Vector{"GL_AMBIENT", GL_AMBIENT, 4},
                                      Vector{"GL_DIFFUSE", GL_DIFFUSE, 4},
                                      Vector{"GL_SPECULAR", GL_SPECULAR, 4},
                                      Vector{"GL_POSITION", GL_POSITION, 4},
                                      Vector{"GL_SPOT_DIRECTION", GL_SPOT_DIRECTION, 3},
                                      Vector{"GL_SPOT_EXPONENT", GL_SPOT_EXPONENT, 1},
                                      Vector{"GL_SPOT_CUTOFF", GL_SPOT_CUTOFF, 1},
                                      Vector{"GL_CONSTANT_ATTENUATION", GL_CONSTANT_ATTENUATION, 1},
                                      Vector{"GL_LINEAR_ATTENUATION", GL_LINEAR_ATTENUATION, 1},
                                      Vector{"GL_QUADRATIC_ATTENUATION", GL_QUADRATIC_ATTENUATION, 1}};
    const int lights = queryInteger(GL_MAX_LIGHTS);
    for (int i = 0; i < lights; ++i) {
        const GLenum light = GL_LIGHT0 + static_cast<GLenum>(i);
        const std::string name = numbered("GL_LIGHT", i);
        writer.query(name, light, Kind::Flag);
        for (const Vector& row : kRows) {
            std::array<GLfloat, 4> values{};
            glGetLightfv(light, row.pname, values.data());
            writer.put(member(name, row.name), floatsText(values.data(), row.count));
        }
    }
}

void writeMaterials(Writer& writer) {
    static constexpr std::array kRows{
        Vector{"GL_AMBIENT", GL_AMBIENT, 4},     Vector{"GL_DIFFUSE", GL_DIFFUSE, 4},
        Vector{"GL_SPECULAR", GL_SPECULAR, 4},   Vector{"GL_EMISSION", GL_EMISSION, 4},
        Vector{"GL_SHININESS", GL_SHININESS, 1}, Vector{"GL_COLOR_INDEXES", GL_COLOR_INDEXES, 3}};
    for (const auto& [face_name, face] : {std::pair{"GL_FRONT", GL_FRONT}, {"GL_BACK", GL_BACK}}) {
        for (const Vector& row : kRows) {
            std::array<GLfloat, 4> values{};
            glGetMaterialfv(static_cast<GLenum>(face), row.pname, values.data());
            writer.put(fmt::format("material {}.{}", face_name, row.name), floatsText(values.data(), row.count));
        }
    }
}

void writeClipPlanes(Writer& writer) {
    const int planes = queryInteger(GL_MAX_CLIP_PLANES);
    for (int i = 0; i < planes; ++i) {
        const GLenum plane = GL_CLIP_PLANE0 + static_cast<GLenum>(i);
        const std::string name = numbered("GL_CLIP_PLANE", i);
        writer.query(name, plane, Kind::Flag);
        std::array<GLdouble, 4> equation{};
        glGetClipPlane(plane, equation.data());
        writer.put(member(name, "equation"),
                   fmt::format("{} {} {} {}", equation[0], equation[1], equation[2], equation[3]));
    }
}

void writeMatrices(Writer& writer) {
    writer.query("GL_MODELVIEW_MATRIX", GL_MODELVIEW_MATRIX, Kind::Float, 16);
    writer.query("GL_MODELVIEW_STACK_DEPTH", GL_MODELVIEW_STACK_DEPTH, Kind::Integer);
    writer.query("GL_PROJECTION_MATRIX", GL_PROJECTION_MATRIX, Kind::Float, 16);
    writer.query("GL_PROJECTION_STACK_DEPTH", GL_PROJECTION_STACK_DEPTH, Kind::Integer);
}

void writePixelMaps(Writer& writer) {
    struct Row {
        const char* name;
        GLenum map;
        GLenum size;
    };
    static constexpr std::array kRows{Row{"GL_PIXEL_MAP_I_TO_I", GL_PIXEL_MAP_I_TO_I, GL_PIXEL_MAP_I_TO_I_SIZE},
                                      Row{"GL_PIXEL_MAP_S_TO_S", GL_PIXEL_MAP_S_TO_S, GL_PIXEL_MAP_S_TO_S_SIZE},
                                      Row{"GL_PIXEL_MAP_I_TO_R", GL_PIXEL_MAP_I_TO_R, GL_PIXEL_MAP_I_TO_R_SIZE},
                                      Row{"GL_PIXEL_MAP_I_TO_G", GL_PIXEL_MAP_I_TO_G, GL_PIXEL_MAP_I_TO_G_SIZE},
                                      Row{"GL_PIXEL_MAP_I_TO_B", GL_PIXEL_MAP_I_TO_B, GL_PIXEL_MAP_I_TO_B_SIZE},
                                      Row{"GL_PIXEL_MAP_I_TO_A", GL_PIXEL_MAP_I_TO_A, GL_PIXEL_MAP_I_TO_A_SIZE},
                                      Row{"GL_PIXEL_MAP_R_TO_R", GL_PIXEL_MAP_R_TO_R, GL_PIXEL_MAP_R_TO_R_SIZE},
                                      Row{"GL_PIXEL_MAP_G_TO_G", GL_PIXEL_MAP_G_TO_G, GL_PIXEL_MAP_G_TO_G_SIZE},
                                      Row{"GL_PIXEL_MAP_B_TO_B", GL_PIXEL_MAP_B_TO_B, GL_PIXEL_MAP_B_TO_B_SIZE},
                                      Row{"GL_PIXEL_MAP_A_TO_A", GL_PIXEL_MAP_A_TO_A, GL_PIXEL_MAP_A_TO_A_SIZE}};
    for (const Row& row : kRows) {
        const int size = std::max(1, queryInteger(row.size));
        std::vector<GLfloat> values(static_cast<std::size_t>(size));
        glGetPixelMapfv(row.map, values.data());
        writer.put(row.name, fmt::format("{}: {}", size, floatsText(values.data(), size)));
    }
}

void writePolygonStipple(Writer& writer) {
    std::array<GLubyte, 128> pattern{};
    glGetPolygonStipple(pattern.data());
    std::string text;
    for (const GLubyte byte : pattern) {
        text += fmt::format("{:02x}", byte);
    }
    writer.put("polygon stipple", text);
}

}  // namespace

void writeFixedFunction(Writer& writer) {
    writeLights(writer);
    writeMaterials(writer);
    writeClipPlanes(writer);
    writeMatrices(writer);
    // These two are returned through the pixel store and the pixel pack buffer.
    const PixelGuard pixels;
    writePixelMaps(writer);
    writePolygonStipple(writer);
}

}  // namespace sluice::host::state
