// SPDX-License-Identifier: MIT
// A particle set in the making: every value that comes from a file passes here once and is checked the same way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "failure.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::particles {

/// Particle radii outside [1 micrometre, 1 kilometre] are taken for a damaged file or a wrong unit.
inline constexpr float kMinRadius = 1e-6F;
inline constexpr float kMaxRadius = 1e3F;
/// Coordinates and velocities beyond this (metres, m/s) would overflow 32-bit products further on.
inline constexpr float kMaxCoordinate = 1e9F;

using Triple = std::array<float, 3>;

[[nodiscard]] bool usableRadius(float radius);
[[nodiscard]] bool usableCoordinate(float value);

/// Collects particles. Each add checks its value and tells index and place on failure.
class Builder {
  public:
    explicit Builder(std::string name) : name_(std::move(name)) {}

    /// Room for `count` particles; the caller has seen that the file is long enough for them.
    void reserve(std::size_t count, bool velocity, bool colour);

    [[nodiscard]] Status addPosition(const Triple& value, Place place);
    [[nodiscard]] Status addVelocity(const Triple& value, Place place);
    /// Finite values outside [0,1] are clamped: Houdini's Cd may exceed 1, the renderer's colour may not.
    [[nodiscard]] Status addColour(const Triple& value, Place place);
    /// One radius for the whole set, as from a header.
    [[nodiscard]] Status setRadius(float value, Place place);
    /// One radius per particle. A set has one: that of all if equal, else their mean.
    [[nodiscard]] Status addRadius(float value, Place place);

    [[nodiscard]] bool hasRadius() const { return radius_count_ > 0 || set_.radius > 0.0F; }
    [[nodiscard]] ParticleSet finish();

  private:
    [[nodiscard]] Error badTriple(const char* what, const Triple& value, Place place, std::size_t index) const;

    std::string name_;
    ParticleSet set_;
    double radius_sum_ = 0.0;
    std::uint64_t radius_count_ = 0;
    float radius_first_ = 0.0F;
    bool radius_varies_ = false;
};

/// The count that a header claims, against kMaxParticles.
[[nodiscard]] Status checkCount(const std::string& name, std::uint64_t count, Place place);

}  // namespace sluice::particles
