// SPDX-License-Identifier: MIT
#include "payload/uniform_blocks.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace sluice::inject {

namespace {

constexpr std::int32_t kMostUniforms = 512;  // of a program, that are asked for
constexpr std::int32_t kColumn = 16;         // bytes from one column to the next, as std140 has them
constexpr std::int32_t kBytes = 64;

std::int32_t uniformValue(const GlCalls& gl, std::uint32_t program, std::uint32_t uniform, std::uint32_t what) {
    std::int32_t value = 0;
    gl.getActiveUniformsiv(program, 1, &uniform, what, &value);
    return value;
}

std::int32_t bufferValue(const GlCalls& gl, std::uint32_t what) {
    std::int32_t value = 0;
    gl.getBufferParameteriv(GL_COPY_READ_BUFFER, what, &value);
    return value;
}

/// Of what is bound to GL_COPY_READ_BUFFER.
bool read(const GlCalls& gl, bool embedded, std::int32_t offset, Matrix& matrix) {
    const bool mapped = bufferValue(gl, GL_BUFFER_MAPPED) != 0;
    if (offset < 0 || bufferValue(gl, GL_BUFFER_SIZE) < offset + kBytes) {
        return false;
    }
    // Any address is to be had, so the kind of context decides, and not whether there is one.
    if (!embedded) {
        if (mapped && (bufferValue(gl, GL_BUFFER_ACCESS_FLAGS) & GL_MAP_PERSISTENT_BIT) == 0) {
            return false;
        }
        gl.getBufferSubData(GL_COPY_READ_BUFFER, offset, kBytes, matrix.data());
        return gl.getError() == GL_NO_ERROR;
    }
    const void* bytes = mapped ? nullptr : gl.mapBufferRange(GL_COPY_READ_BUFFER, offset, kBytes, GL_MAP_READ_BIT);
    if (bytes == nullptr) {
        return false;
    }
    std::memcpy(matrix.data(), bytes, kBytes);
    return gl.unmapBuffer(GL_COPY_READ_BUFFER) != GL_FALSE;
}

}  // namespace

bool hasUniformBlocks(const GlCalls& gl, const ContextFacts& facts) {
    const bool reads =
        facts.embedded ? gl.mapBufferRange != nullptr && gl.unmapBuffer != nullptr : gl.getBufferSubData != nullptr;
    return facts.number >= (facts.embedded ? 30 : 31) && reads && gl.getProgramiv != nullptr &&
           gl.getActiveUniform != nullptr && gl.getActiveUniformsiv != nullptr &&
           gl.getActiveUniformBlockiv != nullptr && gl.getIntegeri != nullptr && gl.bindBuffer != nullptr &&
           gl.getBufferParameteriv != nullptr;
}

std::vector<BlockMatrix> blockMatrices(const GlCalls& gl, std::uint32_t program) {
    std::vector<BlockMatrix> found;
    std::int32_t blocks = 0;
    std::int32_t uniforms = 0;
    gl.getProgramiv(program, GL_ACTIVE_UNIFORM_BLOCKS, &blocks);
    if (blocks <= 0) {
        return found;
    }
    gl.getProgramiv(program, GL_ACTIVE_UNIFORMS, &uniforms);
    for (std::int32_t i = 0; i < std::min(uniforms, kMostUniforms); ++i) {
        const auto uniform = static_cast<std::uint32_t>(i);
        std::array<char, 256> name{};
        std::int32_t size = 0;
        std::uint32_t type = 0;
        gl.getActiveUniform(program, uniform, 255, nullptr, &size, &type, name.data());
        if (type != GL_FLOAT_MAT4 || size != 1) {
            continue;
        }
        const std::int32_t block = uniformValue(gl, program, uniform, GL_UNIFORM_BLOCK_INDEX);
        if (block >= 0 && uniformValue(gl, program, uniform, GL_UNIFORM_MATRIX_STRIDE) == kColumn) {
            found.push_back({static_cast<std::uint32_t>(block), uniformValue(gl, program, uniform, GL_UNIFORM_OFFSET),
                             uniformValue(gl, program, uniform, GL_UNIFORM_IS_ROW_MAJOR) != 0, name.data()});
        }
    }
    return found;
}

bool readBlockMatrix(const GlCalls& gl, bool embedded, std::uint32_t program, const BlockMatrix& where,
                     Matrix& matrix) {
    std::int32_t point = -1;
    std::int32_t buffer = 0;
    std::int32_t start = 0;
    gl.getActiveUniformBlockiv(program, where.block, GL_UNIFORM_BLOCK_BINDING, &point);
    if (point < 0) {
        return false;
    }
    gl.getIntegeri(GL_UNIFORM_BUFFER_BINDING, static_cast<std::uint32_t>(point), &buffer);
    gl.getIntegeri(GL_UNIFORM_BUFFER_START, static_cast<std::uint32_t>(point), &start);
    if (buffer == 0) {
        return false;
    }
    std::int32_t bound = 0;
    gl.getIntegerv(GL_COPY_READ_BUFFER_BINDING, &bound);
    gl.bindBuffer(GL_COPY_READ_BUFFER, static_cast<std::uint32_t>(buffer));
    const bool done = read(gl, embedded, start + where.offset, matrix);
    gl.bindBuffer(GL_COPY_READ_BUFFER, static_cast<std::uint32_t>(bound));
    if (done && where.by_rows) {
        matrix = transposed(matrix);
    }
    return done;
}

}  // namespace sluice::inject
