// SPDX-License-Identifier: MIT
// The fluid of one context: libsluice.so (sluice/sluice.h), loaded when it is first needed.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "payload/settings.hpp"
#include "sluice/result.hpp"

namespace sluice::inject {

/// What it cost, in all frames, as SluiceStatistics has it, and how it fares. whole and begin are of the calling
/// thread.
struct WaterReport {
    std::uint64_t frames = 0, frames_without = 0, steps = 0;
    std::uint32_t particles = 0, renderers = 0;
    std::string device, last_error;
    double units_per_metre = 0;
    std::array<float, 3> up{};
    std::uint32_t restarts = 0;    ///< of a simulation that had failed
    std::uint32_t placements = 0;  ///< in a scene, each with its water from the beginning
    double capture_s = 0, hand_off_s = 0, fluid_s = 0, simulation_s = 0, composite_s = 0, whole_s = 0, begin_s = 0;
};

/// Every call with the context current that it was made in; but destruction finds out for itself whether it still is.
class Water {
  public:
    virtual ~Water() = default;
    /// The frame after this one begins: the fluid flows while the program draws.
    [[nodiscard]] virtual Status begin(double time) = 0;
    /// The scene is complete; draws the fluid into the default framebuffer.
    [[nodiscard]] virtual Status compose(const FoundCamera& camera, double time) = 0;
    /// The scene is another one: the fluid stands before this eye as it stood before the first. One that is placed in
    /// the world goes on, in the unit of this scene.
    [[nodiscard]] virtual Status placeAnew(const FoundCamera& camera, double distance) = 0;
    [[nodiscard]] virtual WaterReport report() = 0;
};

/// Whether it is the last line that libsluice.so had written to stderr.
[[nodiscard]] bool wasSaid(const std::string& message);

/// `folder`: of the payload, with a slash; libsluice.so lies there or, installed, above it. `distance`: of what is
/// seen, in the program's units.
[[nodiscard]] Result<std::unique_ptr<Water>> createWater(const std::string& folder, const Settings& settings,
                                                         const FoundCamera& camera, double distance);

}  // namespace sluice::inject
