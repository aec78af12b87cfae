// SPDX-License-Identifier: MIT
#include "isolate/proxy_simulation.hpp"

#include <fmt/format.h>

#include <chrono>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "frame/check_info.hpp"
#include "isolate/proxy_parts.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/simulation_arrays.hpp"
#include "sluice/trace.hpp"

namespace sluice::host::proxy {

namespace {

// Short against a frame, long against a message and its answer.
constexpr std::chrono::microseconds kAskAgain{500};

Status endSimulation(RendererProcess& process) {
    isolate::SetSimulation call;
    call.simulation = sized<SluiceSimulation>();
    return simply(process, call, "set_simulation", {});
}

SluiceResult setSimulation(SluiceRenderer* renderer, const SluiceSimulation* simulation, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        RendererProcess& process = *of(renderer)->process;
        if (simulation == nullptr) {
            return endSimulation(process);
        }
        // What is wrong with it is found before its arrays are read, and leaves none over there either.
        if (Status status = checkPart(simulation); !status) {
            (void)endSimulation(process);
            return status;
        }
        const SluiceSimulation given = readAbiStruct(*simulation);
        isolate::SetSimulation call;
        call.simulation = given;
        eachArray(call.simulation, false,
                  [](const char* /*name*/, auto& array, std::size_t /*elements*/, std::size_t /*most*/) {
                      array = nullptr;  // an address of this process is none of the other's
                  });
        call.has_velocity = given.velocity != nullptr ? 1 : 0;
        std::vector<std::span<const std::byte>> parts;
        eachArray(given, given.velocity != nullptr,
                  [&](const char* /*name*/, const auto* array, std::size_t elements, std::size_t /*most*/) {
                      parts.push_back(std::as_bytes(std::span(array, elements)));
                  });
        const Result<UniqueFd> copy = isolate::sealedCopy(parts);
        if (!copy) {
            (void)endSimulation(process);
            return copy.error();
        }
        const int fd = copy.value().get();
        return simply(process, call, fmt::format("set_simulation of {} particles", given.particle_count), {},
                      std::span(&fd, 1));
    });
}

SluiceResult simulate(SluiceRenderer* renderer, std::uint64_t value, double seconds, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        return simply(*of(renderer)->process, isolate::Simulate{{}, value, seconds},
                      fmt::format("simulate of value {}", value), {});
    });
}

SluiceResult simulationStats(SluiceRenderer* renderer, SluiceSimulationStats* stats) {
    return guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(stats, "stats"); !status) {
            return status;
        }
        Result<Reply> reply = of(renderer)->process->call(isolate::SimulationStats{}, {}, "simulation_stats", {});
        return reply ? filledBy(reply.value().returned, stats, "stats") : Status{reply.error()};
    });
}

SluiceResult simulationWait(SluiceRenderer* renderer, std::uint64_t value, std::uint64_t timeout_ns) {
    const std::uint64_t began = monotonicNanoseconds();
    for (;;) {
        auto stats = sized<SluiceSimulationStats>();
        if (const SluiceResult result = simulationStats(renderer, &stats); result != SLUICE_OK) {
            return result;
        }
        if (stats.reached >= value) {
            return SLUICE_OK;
        }
        if (monotonicNanoseconds() - began >= timeout_ns) {
            return SLUICE_TIMEOUT;
        }
        std::this_thread::sleep_for(kAskAgain);
    }
}

SluiceResult simulationBodies(SluiceRenderer* renderer, std::uint64_t value, SluiceBodies* bodies) {
    return guarded(nullptr, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(bodies, "bodies"); !status) {
            return status;
        }
        Result<Reply> reply =
            of(renderer)->process->call(isolate::SimulationBodies{{}, value}, {}, "simulation_bodies", {});
        return reply ? filledBy(reply.value().returned, bodies, "bodies") : Status{reply.error()};
    });
}

SluiceResult setBody(SluiceRenderer* renderer, std::uint32_t body, const SluiceBodyTarget* target, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(target, "target"); !status) {
            return status;
        }
        return simply(*of(renderer)->process, isolate::SetBody{{}, body, readAbiStruct(*target)}, "set_body", {});
    });
}

SluiceResult setFlow(SluiceRenderer* renderer, const SluiceFlow* flow, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkAbiStruct(flow, "flow"); !status) {
            return status;
        }
        return simply(*of(renderer)->process, isolate::SetFlow{{}, readAbiStruct(*flow)}, "set_flow", {});
    });
}

SluiceResult resetSimulation(SluiceRenderer* renderer, const SluiceStart* start, SluiceError* error) {
    return guarded(error, [&]() -> Status {
        if (renderer == nullptr) {
            return isNull("renderer");
        }
        if (Status status = checkPart(start); !status) {
            return status;
        }
        const SluiceStart given = readAbiStruct(*start);
        isolate::ResetSimulation call{
            {}, given.velocity != nullptr ? 1U : 0U, given.particle_fluids != nullptr ? 1U : 0U, given};
        call.start.position = call.start.velocity = nullptr;
        call.start.particle_fluids = nullptr;
        const std::string doing = fmt::format("reset_simulation to {} particles", given.particle_count);
        if (given.particle_count == 0) {
            return simply(*of(renderer)->process, call, doing, {});
        }
        const std::size_t floats = std::size_t{3} * given.particle_count;
        std::vector<std::span<const std::byte>> parts{std::as_bytes(std::span(given.position, floats))};
        if (given.velocity != nullptr) {
            parts.push_back(std::as_bytes(std::span(given.velocity, floats)));
        }
        if (given.particle_fluids != nullptr) {
            parts.push_back(std::as_bytes(std::span(given.particle_fluids, given.particle_count)));
        }
        const Result<UniqueFd> copy = isolate::sealedCopy(parts);
        if (!copy) {
            return copy.error();
        }
        const int fd = copy.value().get();
        return simply(*of(renderer)->process, call, doing, {}, std::span(&fd, 1));
    });
}

}  // namespace

void addSimulation(SluiceRendererApi& table) {
    table.set_simulation = setSimulation;
    table.simulate = simulate;
    table.simulation_wait = simulationWait;
    table.simulation_stats = simulationStats;
    table.simulation_bodies = simulationBodies;
    table.set_body = setBody;
    table.set_flow = setFlow;
    table.reset_simulation = resetSimulation;
}

}  // namespace sluice::host::proxy
