// SPDX-License-Identifier: MIT
// A fluid that begins anew while it flows.
#include <fmt/format.h>

#include <utility>

#include "live/live_simulation.hpp"

namespace sluice::vk {

Status LiveSimulation::reset(LiveStart start) {
    const std::size_t count = start.position.size() / 3;
    if (count > most_particles_ || (count == 0 && settings_.sources.emitters.empty())) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "start",
                     fmt::format("expected {}{} particles, found {}",
                                 settings_.sources.emitters.empty() ? "1 to " : "at most ", most_particles_, count),
                     "set_simulation makes room for max_particles"};
    }
    if (Status status = checkParticles(settings_, start.position, start.velocity, start.fluid); !status) {
        return status;
    }
    start_ = std::make_unique<LiveStart>(std::move(start));
    return {};
}

Status LiveSimulation::beginAnew(const LiveStart& start) {
    if (Status status = solver_->setParticles(start.position, start.velocity, start.fluid); !status) {
        return status;
    }
    slots_->forgetFoam();
    owed_ = 0.0;
    targets_.clear();
    const std::lock_guard lock(mutex_);
    stats_.particle_count = solver_->count();
    stats_.failed = 0;
    stats_.message[0] = '\0';
    return {};
}

}  // namespace sluice::vk
