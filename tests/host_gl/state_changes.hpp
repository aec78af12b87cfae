// SPDX-License-Identifier: MIT
// Single state changes, and the one line of a snapshot that each must move.
#pragma once

#include <epoxy/gl.h>

#include <ostream>
#include <span>
#include <string_view>

namespace sluice::host::test {

/// Names of every kind of object that can be bound, made before the first snapshot.
class SpareObjects {
  public:
    SpareObjects();
    SpareObjects(const SpareObjects&) = delete;
    SpareObjects& operator=(const SpareObjects&) = delete;
    ~SpareObjects();

    GLuint texture_2d = 0, texture_3d = 0, texture_cube = 0, framebuffer = 0, bound_framebuffer = 0, program = 0,
           buffer = 0, renderbuffer = 0, sampler = 0, vertex_array = 0, query = 0;
};

struct StateChange {
    std::string_view test_name;
    std::string_view line;  ///< the name of the state that the snapshot must report
    void (*make)(const SpareObjects&);
};
/// For GoogleTest's messages.
inline void PrintTo(const StateChange& change, std::ostream* out) {
    *out << change.line;
}

[[nodiscard]] std::span<const StateChange> stateChanges();

}  // namespace sluice::host::test
