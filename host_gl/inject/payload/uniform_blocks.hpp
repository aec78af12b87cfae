// SPDX-License-Identifier: MIT
// Matrices that a program keeps in uniform blocks: where they stand, and what they are now.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "payload/gl_calls.hpp"
#include "tracker/projection.hpp"

namespace sluice::inject {

/// One mat4 of a block, no array.
struct BlockMatrix {
    std::uint32_t block = 0;
    std::int32_t offset = 0;
    bool by_rows = false;
    std::string name;
};

/// Whether a context of this kind has blocks, and we the functions.
[[nodiscard]] bool hasUniformBlocks(const GlCalls& gl, const ContextFacts& facts);
/// Of a linked program. May raise GL errors, as the next one.
[[nodiscard]] std::vector<BlockMatrix> blockMatrices(const GlCalls& gl, std::uint32_t program);
/// Out of the buffer that is bound to its block now; false if there is none, or it is the program's to write (mapped).
/// Leaves the bindings as they were. `embedded`: in a context of OpenGL ES.
[[nodiscard]] bool readBlockMatrix(const GlCalls& gl, bool embedded, std::uint32_t program, const BlockMatrix& where,
                                   Matrix& matrix);

}  // namespace sluice::inject
