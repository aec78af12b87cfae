// SPDX-License-Identifier: MIT
// What a scene's simulation begins with. Pure.
#pragma once

#include <cstdint>

#include "simulator/simulator.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

/// At most this many particles: the solver's lists for more would not fit the device's buffers.
inline constexpr std::uint64_t kMostSimulated = 4'000'000;

/// The solver's numbers and solids: those of the scene's simulation and, if it says so, those of its engine. What is
/// seen of the engine instead is not in it.
[[nodiscard]] simulator::Setup simulationSetup(const scene::Scene& scene);

/// A lattice of spacing 2r in every box of fluid, each particle moved by up to `jitter` radii along each axis by
/// `seed`, without those that would lie in a solid. The same arguments give the same bits. An error if there is no
/// fluid and no emitter, or too much fluid.
[[nodiscard]] Result<simulator::Particles> startOfFluid(const scene::Simulation& simulation,
                                                        const simulator::Setup& setup, std::uint64_t seed);

/// 64-bit FNV-1a over the bits of `particles`, going on from `hash`.
[[nodiscard]] std::uint64_t replayHash(const simulator::Particles& particles, std::uint64_t hash);
inline constexpr std::uint64_t kReplayHashStart = 0xcbf29ce484222325U;

}  // namespace sluice::cli
