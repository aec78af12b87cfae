// SPDX-License-Identifier: MIT
// The contents: a chain in which every texel tells which turns it has been through, in which order. Pure.
//
// A turn makes of each texel of its inputs one texel of its output:
//   x = 0; for input j: x = mix(x, input j, salt + j, index)     (without inputs: x = mix(0, 0, salt, index))
// where salt is the turn's own number. mix is a bijection in the texel for every salt, so that a wrong texel never
// becomes right again; and two mixes with different salts do not commute, so that a hand-off left out, doubled, late
// or in the wrong order shows. Both GPUs compute it (gl/programs.cpp, shaders/common/stress.glsl) and the CPU says what
// must come out. Words of the float formats have 24 bits, which a float holds exactly.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "stress/options.hpp"

namespace sluice::stress {

using Words = std::vector<std::uint32_t>;

/// All ones of the word of a resource: 32 bits, or 24 for the float formats.
[[nodiscard]] std::uint32_t wordMask(Resource resource);
[[nodiscard]] std::uint32_t mix(std::uint32_t x, std::uint32_t input, std::uint32_t salt, std::uint32_t index,
                                std::uint32_t mask);
/// The salt of turn number `turn` of a run.
[[nodiscard]] std::uint32_t saltOf(std::uint64_t seed, std::uint64_t turn);

/// Texels as read back (GL transfer layout, tightly packed) to words. A float that is not the exact image of a word
/// becomes all ones of 32 bits, which no word of a float format is.
[[nodiscard]] Words decode(Resource resource, std::span<const std::byte> texels);

/// What one side does once: reads slots, writes a slot. `version` is the turn's number.
struct Turn {
    std::vector<std::uint32_t> inputs;
    std::vector<std::uint64_t> input_versions;
    std::uint32_t output = 0;
    std::uint64_t version = 0;
    std::uint32_t salt = 0;
};

/// How what was found compares with what must be there.
enum class Finding : std::uint8_t {
    Right,
    Stale,  ///< every texel is that of one earlier version of the slot
    Torn,   ///< texels of several versions
    Wrong   ///< none of the versions that are remembered: damaged by an earlier hand-off
};

/// What every slot must hold.
class Model {
  public:
    void restart(Resource resource, std::uint32_t texels, std::uint32_t slots);
    void apply(const Turn& turn);
    /// `bad` counts the texels that differ from the newest version. A slot that was never written is right.
    [[nodiscard]] Finding compare(std::uint32_t slot, const Words& found, std::uint64_t& bad,
                                  std::uint64_t& found_version) const;

  private:
    struct Version {
        std::uint64_t number = 0;
        Words words;
    };
    std::uint32_t mask_ = 0, texels_ = 0;
    std::vector<std::vector<Version>> slots_;  // the newest last
};

}  // namespace sluice::stress
