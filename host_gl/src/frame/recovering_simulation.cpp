// SPDX-License-Identifier: MIT
// A simulation over one renderer after the other.
#include <fmt/format.h>

#include "frame/recovering_host.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::host {

Status RecoveringHost::setSimulation(const SluiceSimulation* simulation) {
    return caught([&] {
        Status status = give([&] { return life_->setSimulation(simulation); }, simulation);
        if (refused(status)) {
            scene_.keep(static_cast<const SluiceSimulation*>(nullptr));  // on failure there is none
        }
        flow_.reset();
        asked_ = 0;
        simulation_base_ = 0;
        simulation_dropped_ = false;
        return status;
    });
}

Status RecoveringHost::simulate(std::uint64_t value, double seconds) {
    return caught([&]() -> Status {
        if (value != asked_ + 1) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulate",
                         fmt::format("value {} came after {}, {} was expected", value, asked_, asked_ + 1),
                         "number values from 1 without gaps"};
        }
        if (recovery_.down() || simulation_dropped_) {
            asked_ = value;  // nothing flows without a renderer, or in one that has refused it
            return {};
        }
        Status status = judged(life_->simulate(simulatedHere(value), seconds));
        if (status || recovery_.down()) {
            asked_ = value;
        }
        return status;
    });
}

Status RecoveringHost::waitForSimulation(std::uint64_t value, std::uint64_t timeout_ns) {
    return caught([&]() -> Status {
        if (recovery_.down()) {
            return whileDown("simulation_wait");
        }
        return judged(life_->waitForSimulation(simulatedHere(value), timeout_ns));
    });
}

Result<SluiceSimulationStats> RecoveringHost::simulationStats() {
    SluiceSimulationStats found{};
    const Status status = caught([&]() -> Status {
        if (recovery_.down()) {
            return whileDown("simulation_stats");
        }
        Result<SluiceSimulationStats> stats = life_->simulationStats();
        if (!stats) {
            return stats.error();
        }
        found = stats.value();
        found.asked += simulation_base_;
        found.reached += simulation_base_;
        found.failed += found.failed != 0 ? simulation_base_ : 0;
        return {};
    });
    if (!status) {
        return status.error();
    }
    return found;
}

Result<SluiceBodies> RecoveringHost::simulationBodies(std::uint64_t value) {
    SluiceBodies found{};
    const Status status = caught([&]() -> Status {
        if (recovery_.down()) {
            return whileDown("simulation_bodies");
        }
        Result<SluiceBodies> bodies = life_->simulationBodies(simulatedHere(value));
        if (!bodies) {
            return bodies.error();
        }
        found = bodies.value();
        found.value += found.value != 0 ? simulation_base_ : 0;
        return {};
    });
    if (!status) {
        return status.error();
    }
    return found;
}

Status RecoveringHost::setBody(std::uint32_t body, const SluiceBodyTarget& target) {
    return caught([&]() -> Status {
        if (recovery_.down() || simulation_dropped_) {
            return {};  // nothing moves without a renderer, or in one that has refused it
        }
        return judged(life_->setBody(body, target));
    });
}

Status RecoveringHost::setFlow(const SluiceFlow& flow) {
    return caught([&]() -> Status {
        if (simulation_dropped_) {
            return {};
        }
        Status status = recovery_.down() ? Status{} : judged(life_->setFlow(flow));
        if (!refused(status)) {
            flow_ = flowAfter(flow_, flow);
        }
        return status;
    });
}

Status RecoveringHost::resetSimulation(const SluiceStart& start) {
    return caught([&]() -> Status {
        if (Status status = checkPart(&start); !status) {
            return status;
        }
        if (simulation_dropped_) {
            return {};  // nothing flows in a renderer that has refused it
        }
        if (recovery_.down() && !scene_.simulation()) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "reset_simulation", "there is no simulation",
                         "call setSimulation first"};
        }
        Status status = recovery_.down() ? Status{} : judged(life_->resetSimulation(start));
        if (recovers() && !refused(status)) {
            scene_.keep(start);
            reset_for_ = asked_ + 1;
        }
        return status;
    });
}

// What is refused here was given while there was no renderer to look at it.
Status RecoveringHost::changeAgain() {
    if (flow_) {
        const Status status = life_->setFlow(*flow_);
        if (refused(status)) {
            drop("flow", status.error());
            flow_.reset();
        } else if (!status) {
            return status;
        }
    }
    if (const auto start = scene_.start()) {
        const Status status = life_->resetSimulation(*start);
        if (refused(status)) {
            drop("start", status.error());
            scene_.forgetStart();
        } else if (!status) {
            return status;
        }
    }
    return {};
}

Status RecoveringHost::simulateAgain(const SluiceSimulation& simulation) {
    Status status = life_->setSimulation(&simulation);
    if (status) {
        status = changeAgain();
    }
    if (!status || asked_ == 0) {
        return status;
    }
    simulation_base_ = asked_ - 1;
    log(SLUICE_LOG_WARNING,
        fmt::format("simulation: what had flowed went with the renderer; from value {} on it begins again{}", asked_,
                    scene_.start() ? fmt::format(", with what it was reset to for value {}", reset_for_) : ""));
    return life_->simulate(1, 0.0);
}

std::uint64_t RecoveringHost::simulatedHere(std::uint64_t value) const {
    if (value == 0 || simulation_dropped_) {
        return 0;
    }
    return value > simulation_base_ ? value - simulation_base_ : 1;
}

}  // namespace sluice::host
