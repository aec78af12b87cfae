// SPDX-License-Identifier: MIT
// The chain of `sluice stress` (cli/stress/chain.hpp): one turn over up to four inputs.
// Codec: how a texel holds a word. 0: four bytes of RGBA8; 1: R32F, the number itself; 2: D32F, the number / 2^24.
layout(constant_id = 0) const uint kCodec = 0u;
layout(constant_id = 1) const uint kMask = 0xFFFFFFFFu;

layout(push_constant) uniform Turn {
    uint salt;
    uint inputs;  // 0 to 4
    uint width;
    uint texels;
} turn;

uint mixWord(uint x, uint word, uint salt, uint index) {
    x = (x * 0x9E3779B1u + word) & kMask;
    x = (x ^ (salt + index * 0x85EBCA6Bu)) & kMask;
    x = (x * 0xC2B2AE35u) & kMask;
    x ^= x >> 11;
    x = (x * 0x27D4EB2Fu) & kMask;
    x ^= x >> 13;
    return x;
}
