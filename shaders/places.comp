// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// Counts who lives before whom, so that particles lie without gaps in the order of their identities, whatever has come and
// gone. Four turns, each a dispatch: marks a bit for each identity that lives; sums the bits of each block of words; adds
// up the blocks, by one invocation; and writes what stands before each word. No shared memory: docs/architecture.md.
// Inputs:  position.w (0: lives) and identity in the solver's order. Outputs: marks, and before, as places.glsl reads them.
layout(local_size_x = 64) in;

layout(push_constant) uniform Push {
    uint turn;
    uint entries;
    uint words;
    uint block;  // words of one
} push;
layout(std430, set = 0, binding = 0) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 1) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 2) buffer Marks { uint marks[]; };
layout(std430, set = 0, binding = 3) buffer Before { uint before[]; };
layout(std430, set = 0, binding = 4) buffer Sums { uint sums[]; };

void mark(uint i) {
    if (i < push.entries && position[i].w == 0.0) {
        atomicOr(marks[identity[i] >> 5], 1u << (identity[i] & 31u));
    }
}

void sumOrWrite(uint block, bool writes) {
    const uint first = block * push.block;
    if (first >= push.words) {
        return;
    }
    uint sum = writes ? sums[block] : 0u;
    for (uint word = first; word < min(first + push.block, push.words); ++word) {
        if (writes) {
            before[word] = sum;
        }
        sum += uint(bitCount(marks[word]));
    }
    if (!writes) {
        sums[block] = sum;
    }
}

void addUp() {
    uint sum = 0u;
    const uint blocks = (push.words + push.block - 1u) / push.block;
    for (uint block = 0u; block < blocks; ++block) {
        const uint own = sums[block];
        sums[block] = sum;
        sum += own;
    }
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (push.turn == 0u) {
        mark(i);
    } else if (push.turn != 2u) {
        sumOrWrite(i, push.turn == 3u);
    } else if (i == 0u) {
        addUp();
    }
}
