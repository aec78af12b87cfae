// SPDX-License-Identifier: MIT
// The procedural pictures on the scene's surfaces. Each repeats seamlessly in the directions that its surface repeats.
#pragma once

#include "engine/noise.hpp"
#include "engine/texture.hpp"

namespace sluice::host {

/// Metres of surface that one period of each texture covers.
inline constexpr float kPavingMetres = 2.0F;
inline constexpr float kAshlarMetres = 1.2F;
inline constexpr float kLimestoneMetres = 1.0F;
inline constexpr float kPoolWallMetres = 0.85F;
inline constexpr float kArcadeMetres = 3.0F;
/// Times that the flutes' texture goes around a pillar.
inline constexpr float kShaftTurns = 5.0F;

[[nodiscard]] Image paintPaving(const NoiseField& noise);     ///< octagonal limestone tiles with coloured insets
[[nodiscard]] Image paintPoolFloor(const NoiseField& noise);  ///< mosaic medallion; covers a pool's floor once
[[nodiscard]] Image paintPoolWall(const NoiseField& noise);   ///< mosaic with a band; v = 0 at the foot, 1 at the rim
[[nodiscard]] Image paintAshlar(const NoiseField& noise);     ///< coursed sandstone
[[nodiscard]] Image paintLimestone(const NoiseField& noise);  ///< plain dressed stone
[[nodiscard]] Image paintShaft(const NoiseField& noise);      ///< flutes
[[nodiscard]] Image paintArcade(const NoiseField& noise);     ///< a blind arch; v = 0 at the foot, 1 at the top
[[nodiscard]] Image paintCrate(const NoiseField& noise);      ///< one face: frame, planks, brace

}  // namespace sluice::host
