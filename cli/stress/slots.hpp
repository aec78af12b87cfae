// SPDX-License-Identifier: MIT
// The numbers by which all parts speak of the same resources.
#pragma once

#include <cstdint>

#include "sluice/fd.hpp"
#include "stress/options.hpp"
#include "stress/plan.hpp"

namespace sluice::stress {

/// Per set one resource that OpenGL writes and `fan` that Vulkan writes; all of them shared. Behind them two of each
/// side's own, between which one-way patterns carry their chain on: those numbers mean different memory on either side.
struct Slots {
    Shape shape;

    [[nodiscard]] std::uint32_t host(std::uint32_t set) const { return set; }
    [[nodiscard]] std::uint32_t renderer(std::uint32_t set, std::uint32_t j) const {
        return shape.sets + set * shape.fan + j;
    }
    [[nodiscard]] std::uint32_t shared() const { return shape.sets * (1 + shape.fan); }
    [[nodiscard]] std::uint32_t own(std::uint32_t parity) const { return shared() + parity; }
    [[nodiscard]] std::uint32_t count() const { return shared() + 2; }
};

/// What both sides have to make.
struct Storage {
    Resource resource = Resource::Colour;
    std::uint32_t width = 0, height = 0;
    Slots slots;
    [[nodiscard]] std::uint32_t texels() const { return width * height; }
};

/// The memory of a shared slot, for OpenGL.
struct ExportedSlot {
    UniqueFd fd;
    std::uint64_t bytes = 0;  ///< of the whole allocation
};

inline constexpr std::uint32_t kNoSlot = 0xFFFFFFFF;
/// Layouts by Vulkan's numbers: what shared images are in, and what a wrong acquire names (TRANSFER_SRC_OPTIMAL).
inline constexpr std::uint32_t kSharedLayout = 1, kWrongLayout = 6;

/// Semaphores of one submission.
struct Hand {
    bool waits = true;                     ///< false: the queue does not wait
    std::uint64_t wait = 0;                ///< value of host-to-renderer
    std::uint64_t signal = 0;              ///< value of renderer-to-host; 0: none
    std::uint32_t wrong_layout = kNoSlot;  ///< the slot whose acquire names a layout that it is not in
};

/// Inputs of one turn, at most.
inline constexpr std::uint32_t kMaxInputs = kMaxSets;

}  // namespace sluice::stress
