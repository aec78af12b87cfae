// SPDX-License-Identifier: MIT
// Numbers that look random and follow from a seed, the same on every machine.
#pragma once

#include <cstdint>

namespace sluice::stress {

/// SplitMix64 (Steele, Lea, Flood 2014): any 64-bit state will do, so that a seed may be any number.
class Chance {
  public:
    explicit constexpr Chance(std::uint64_t seed) : state_(seed) {}

    constexpr std::uint64_t next() {
        state_ += 0x9E3779B97F4A7C15ULL;
        std::uint64_t z = state_;
        z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
        return z ^ (z >> 31U);
    }
    /// From `least` to `most`, both included. The bias of the remainder is far below what a plan could notice.
    constexpr std::uint32_t between(std::uint32_t least, std::uint32_t most) {
        return least + static_cast<std::uint32_t>(next() % (std::uint64_t{most} - least + 1));
    }

  private:
    std::uint64_t state_;
};

}  // namespace sluice::stress
