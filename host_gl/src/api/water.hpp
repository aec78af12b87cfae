// SPDX-License-Identifier: MIT
// A SluiceWater as the renderer takes it.
#pragma once

#include <cstdint>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"
#include "sluice/sluice.h"

namespace sluice::host {

/// Owns the particles of a SluiceSimulation whose other arrays are the caller's.
struct Water {
    SluiceSimulation settings{};
    std::vector<float> position, velocity;
    std::vector<std::uint32_t> fluid;  ///< of each particle; empty where there is one

    /// Must outlive neither this nor the SluiceWater that it was made of.
    [[nodiscard]] SluiceSimulation view() const;
    [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(position.size() / 3); }
};

[[nodiscard]] SluiceWater defaultWater();
/// What it begins with.
[[nodiscard]] SluiceFlow flowOf(const SluiceWater& water);

/// Fills the blocks with particles two radii apart, without those inside a solid. Pure.
[[nodiscard]] Result<Water> makeWater(const SluiceWater& asked);

}  // namespace sluice::host
