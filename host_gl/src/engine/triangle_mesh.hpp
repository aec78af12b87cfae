// SPDX-License-Identifier: MIT
// A mesh of triangles in immediate mode.
#pragma once

#include "sluice/host_gl/engine.hpp"

namespace sluice::host {

/// With normals, and the texture's coordinates along the two axes that a triangle faces least.
void emitTriangles(const TriangleMesh& mesh);

}  // namespace sluice::host
