// SPDX-License-Identifier: MIT
// Objects for state changes to bind.
#pragma once

#include <epoxy/gl.h>

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

}  // namespace sluice::host::test
