// SPDX-License-Identifier: MIT
// Client arrays of the fixed function and generic vertex attributes, of the bound vertex array object.
#include <fmt/format.h>

#include <array>

#include "state/writer.hpp"

namespace sluice::host::state {
namespace {

/// 0 stands for a property that the array does not have.
struct ClientArray {
    const char* name;
    GLenum array, size, type, stride, pointer, buffer;
};

constexpr std::array kArrays{
    ClientArray{"GL_VERTEX_ARRAY", GL_VERTEX_ARRAY, GL_VERTEX_ARRAY_SIZE, GL_VERTEX_ARRAY_TYPE, GL_VERTEX_ARRAY_STRIDE,
                GL_VERTEX_ARRAY_POINTER, GL_VERTEX_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_NORMAL_ARRAY", GL_NORMAL_ARRAY, 0, GL_NORMAL_ARRAY_TYPE, GL_NORMAL_ARRAY_STRIDE,
                GL_NORMAL_ARRAY_POINTER, GL_NORMAL_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_COLOR_ARRAY", GL_COLOR_ARRAY, GL_COLOR_ARRAY_SIZE, GL_COLOR_ARRAY_TYPE, GL_COLOR_ARRAY_STRIDE,
                GL_COLOR_ARRAY_POINTER, GL_COLOR_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_SECONDARY_COLOR_ARRAY", GL_SECONDARY_COLOR_ARRAY, GL_SECONDARY_COLOR_ARRAY_SIZE,
                GL_SECONDARY_COLOR_ARRAY_TYPE, GL_SECONDARY_COLOR_ARRAY_STRIDE, GL_SECONDARY_COLOR_ARRAY_POINTER,
                GL_SECONDARY_COLOR_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_INDEX_ARRAY", GL_INDEX_ARRAY, 0, GL_INDEX_ARRAY_TYPE, GL_INDEX_ARRAY_STRIDE, GL_INDEX_ARRAY_POINTER,
                GL_INDEX_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_EDGE_FLAG_ARRAY", GL_EDGE_FLAG_ARRAY, 0, 0, GL_EDGE_FLAG_ARRAY_STRIDE, GL_EDGE_FLAG_ARRAY_POINTER,
                GL_EDGE_FLAG_ARRAY_BUFFER_BINDING},
    ClientArray{"GL_FOG_COORD_ARRAY", GL_FOG_COORD_ARRAY, 0, GL_FOG_COORD_ARRAY_TYPE, GL_FOG_COORD_ARRAY_STRIDE,
                GL_FOG_COORD_ARRAY_POINTER, GL_FOG_COORD_ARRAY_BUFFER_BINDING},
};
constexpr ClientArray kTextureCoordinates{"GL_TEXTURE_COORD_ARRAY",
                                          GL_TEXTURE_COORD_ARRAY,
                                          GL_TEXTURE_COORD_ARRAY_SIZE,
                                          GL_TEXTURE_COORD_ARRAY_TYPE,
                                          GL_TEXTURE_COORD_ARRAY_STRIDE,
                                          GL_TEXTURE_COORD_ARRAY_POINTER,
                                          GL_TEXTURE_COORD_ARRAY_BUFFER_BINDING};

void writeClientArray(Writer& writer, const std::string& name, const ClientArray& array) {
    writer.query(name, array.array, Kind::Flag);
    if (array.size != 0) {
        writer.query(member(name, "size"), array.size, Kind::Integer);
    }
    if (array.type != 0) {
        writer.query(member(name, "type"), array.type, Kind::Enumerant);
    }
    writer.query(member(name, "stride"), array.stride, Kind::Integer);
    writer.query(member(name, "buffer"), array.buffer, Kind::Integer);
    GLvoid* pointer = nullptr;
    glGetPointerv(array.pointer, &pointer);
    writer.put(member(name, "pointer"), fmt::format("{}", fmt::ptr(pointer)));
}

struct Attribute {
    const char* name;
    GLenum pname;
    Since since{};
};

constexpr std::array kAttributes{
    Attribute{"enabled", GL_VERTEX_ATTRIB_ARRAY_ENABLED},
    Attribute{"size", GL_VERTEX_ATTRIB_ARRAY_SIZE},
    Attribute{"stride", GL_VERTEX_ATTRIB_ARRAY_STRIDE},
    Attribute{"type", GL_VERTEX_ATTRIB_ARRAY_TYPE},
    Attribute{"normalised", GL_VERTEX_ATTRIB_ARRAY_NORMALIZED},
    Attribute{"buffer", GL_VERTEX_ATTRIB_ARRAY_BUFFER_BINDING},
    Attribute{"integer", GL_VERTEX_ATTRIB_ARRAY_INTEGER, {30, nullptr}},
    Attribute{"divisor", GL_VERTEX_ATTRIB_ARRAY_DIVISOR, {33, "GL_ARB_instanced_arrays"}},
    Attribute{"binding", GL_VERTEX_ATTRIB_BINDING, {43, "GL_ARB_vertex_attrib_binding"}},
    Attribute{"relative offset", GL_VERTEX_ATTRIB_RELATIVE_OFFSET, {43, "GL_ARB_vertex_attrib_binding"}},
};

void writeAttributes(Writer& writer) {
    const int attributes = queryInteger(GL_MAX_VERTEX_ATTRIBS);
    for (int i = 0; i < attributes; ++i) {
        const std::string name = numbered("attribute ", i);
        const auto index = static_cast<GLuint>(i);
        for (const Attribute& row : kAttributes) {
            if (available(row.since)) {
                GLint value = 0;
                glGetVertexAttribiv(index, row.pname, &value);
                writer.put(member(name, row.name), integersText(&value, 1, Kind::Integer));
            }
        }
        GLvoid* pointer = nullptr;
        glGetVertexAttribPointerv(index, GL_VERTEX_ATTRIB_ARRAY_POINTER, &pointer);
        writer.put(member(name, "pointer"), fmt::format("{}", fmt::ptr(pointer)));
        // Attribute 0 has no current value of its own: it is the vertex.
        if (i > 0) {
            std::array<GLfloat, 4> current{};
            glGetVertexAttribfv(index, GL_CURRENT_VERTEX_ATTRIB, current.data());
            writer.put(member(name, "current"), floatsText(current.data(), 4));
        }
    }
}

}  // namespace

void writeVertexArrays(Writer& writer) {
    for (const ClientArray& array : kArrays) {
        writeClientArray(writer, array.name, array);
    }
    const GLint active = queryInteger(GL_CLIENT_ACTIVE_TEXTURE);
    const int sets = queryInteger(GL_MAX_TEXTURE_COORDS);
    for (int i = 0; i < sets; ++i) {
        glClientActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(i));
        writeClientArray(writer, member(numbered("unit ", i), kTextureCoordinates.name), kTextureCoordinates);
    }
    glClientActiveTexture(static_cast<GLenum>(active));
    writeAttributes(writer);
}

}  // namespace sluice::host::state
