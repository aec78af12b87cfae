// SPDX-License-Identifier: MIT
// The part of the C ABI that is about a simulation, since ABI 1.1.
#include "plugin/simulation_api.hpp"

#include <fmt/format.h>

#include <utility>

#include "plugin/renderer.hpp"
#include "plugin/simulation_arguments.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/abi_sizes.hpp"

namespace sluice::vk {
namespace {

Error isNull(const char* name) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, name, "it is NULL", ""};
}

}  // namespace

SluiceResult setSimulation(SluiceRenderer* renderer, const SluiceSimulation* simulation, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        // First, so that whatever is wrong with the new one leaves none.
        if (Status ended = renderer->setSimulation(nullptr); !ended || simulation == nullptr) {
            return ended;
        }
        const Result<LiveSetup> setup = readSimulation(simulation);
        return setup ? renderer->setSimulation(&setup.value()) : Status{setup.error()};
    });
}

SluiceResult simulate(SluiceRenderer* renderer, std::uint64_t value, double seconds, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (!(seconds >= 0.0 && seconds <= 3600.0)) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "seconds", fmt::format("{} is outside [0, 3600]", seconds), ""};
        }
        return renderer->simulate(value, seconds);
    });
}

SluiceResult simulationWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    SluiceResult answer = SLUICE_OK;
    const SluiceResult failure = guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (renderer->simulation() == nullptr) {
            return noSimulation("simulation");
        }
        answer = renderer->simulation()->wait(value, timeout_ns);
        return {};
    });
    return failure != SLUICE_OK ? failure : answer;
}

SluiceResult simulationStats(SluiceRenderer* renderer, SluiceSimulationStats* stats) {
    return guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (renderer->simulation() == nullptr) {
            return noSimulation("simulation");
        }
        return writeAbiStruct(stats, renderer->simulation()->stats(), "stats");
    });
}

SluiceResult simulationBodies(SluiceRenderer* renderer, std::uint64_t value, SluiceBodies* bodies) {
    return guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(bodies, "bodies"); !status) {
            return status;
        }
        if (renderer->simulation() == nullptr) {
            return noSimulation("simulation");
        }
        const Result<SluiceBodies> found = renderer->simulation()->bodies(value);
        return found ? writeAbiStruct(bodies, found.value(), "bodies") : Status{found.error()};
    });
}

SluiceResult setBody(SluiceRenderer* renderer, std::uint32_t body, const SluiceBodyTarget* target, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        const Result<BodyTarget> to = readTarget(body, target);
        return to ? renderer->setBody(to.value()) : Status{to.error()};
    });
}

SluiceResult setFlow(SluiceRenderer* renderer, const SluiceFlow* flow, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        const Result<FlowSettings> to = readFlow(flow);
        return to ? renderer->setFlow(to.value()) : Status{to.error()};
    });
}

SluiceResult resetSimulation(SluiceRenderer* renderer, const SluiceStart* start, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        Result<LiveStart> to = readStart(start);
        return to ? renderer->resetSimulation(std::move(to).value()) : Status{to.error()};
    });
}

}  // namespace sluice::vk
