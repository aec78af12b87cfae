// SPDX-License-Identifier: MIT
// Copies of what the caller has given to the renderer, for the renderer after it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sluice/plugin.h"

namespace sluice::host {

/// The particles, the environment and the simulation that were set last. Costs one copy of the arrays a call.
class KeptScene {
  public:
    void keep(const SluiceParticles& particles);
    /// nullptr: the procedural sky.
    void keep(const SluiceEnvironment* environment);
    void forgetParticles() { has_particles_ = false; }
    void forgetEnvironment() { pixels_.clear(); }
    /// nullptr: none. What the one before was reset to goes.
    void keep(const SluiceSimulation* simulation);
    void keep(const SluiceStart& start);
    void forgetStart() { has_start_ = false; }

    /// Views of the copies, valid until the next keep(); empty when nothing was set.
    [[nodiscard]] std::optional<SluiceParticles> particles() const;
    [[nodiscard]] std::optional<SluiceEnvironment> environment() const;
    [[nodiscard]] std::optional<SluiceSimulation> simulation() const;
    [[nodiscard]] std::optional<SluiceStart> start() const;

  private:
    bool has_particles_ = false;
    SluiceParticles particle_facts_{};
    std::vector<float> position_, velocity_, colour_;
    std::vector<std::uint32_t> fluid_;
    SluiceEnvironment environment_facts_{};
    std::vector<float> pixels_;
    SluiceSimulation simulation_facts_{};
    bool has_simulation_ = false, has_velocities_ = false;
    std::vector<std::vector<std::byte>> arrays_;  ///< in the order of eachArray
    bool has_start_ = false;
    std::vector<float> start_position_, start_velocity_;
    std::vector<std::uint32_t> start_fluids_;
};

}  // namespace sluice::host
