// SPDX-License-Identifier: MIT
// Queries GL values as text. A query that the driver refuses becomes "unavailable" instead of a GL error.
#pragma once

#include <epoxy/gl.h>

#include <string>
#include <string_view>

#include "sluice/host_gl/state_snapshot.hpp"

namespace sluice::host::state {

/// When a state can be queried: a desktop version (33 = 3.3), or an extension where older contexts may have one.
struct Since {
    int version = 0;
    const char* extension = nullptr;
};

[[nodiscard]] bool available(const Since& since);

enum class Kind : unsigned char { Flag, Integer, Enumerant, Float };

/// The text of `count` values obtained by glGet*v(pname).
[[nodiscard]] std::string queryText(GLenum pname, Kind kind, int count);

[[nodiscard]] std::string integersText(const GLint* values, int count, Kind kind);
[[nodiscard]] std::string floatsText(const GLfloat* values, int count);
[[nodiscard]] GLint queryInteger(GLenum pname);

/// Appends to a snapshot.
class Writer {
  public:
    explicit Writer(StateSnapshot& snapshot) : snapshot_(snapshot) {}
    /// Adds the value, or "unavailable" if the queries since the last put raised an error.
    void put(std::string name, std::string value);
    void query(std::string name, GLenum pname, Kind kind, int count = 1);

  private:
    StateSnapshot& snapshot_;
};

/// "GL_LIGHT0.GL_DIFFUSE", "unit 3.GL_TEXTURE_BINDING_2D".
[[nodiscard]] std::string member(std::string_view object, std::string_view name);
[[nodiscard]] std::string numbered(std::string_view stem, int index);

// One function per group of state, in the order of the snapshot.
void writeTables(Writer& writer);         ///< switches and values that one glGet returns
void writeOutputs(Writer& writer);        ///< per viewport and per draw buffer, collapsed where all are equal
void writeFixedFunction(Writer& writer);  ///< lights, materials, clip planes, matrices, pixel maps, stipple
void writeTextureUnits(Writer& writer);
void writeVertexArrays(Writer& writer);
void writeBufferBindings(Writer& writer);

}  // namespace sluice::host::state
