// SPDX-License-Identifier: MIT
// Room for a solver's particles, and for those that are born.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "simulation/solver_state.hpp"
#include "simulation/transfer.hpp"

namespace sluice::vk {
namespace {

/// Rows of the lists to begin with; at rest a particle has 32 neighbours.
constexpr std::uint32_t kFirstNeighbours = 64;

}  // namespace

Status Solver::State::makeRoom(std::uint32_t particles, bool keep_state) {
    const std::uint32_t most = device.properties.limits.maxComputeWorkGroupCount[0];
    if (groupsOf(particles, kGroup) > most) {
        return Error{SLUICE_ERROR_UNSUPPORTED, "simulation",
                     fmt::format("{} particles are {} workgroups, and this device dispatches at most {}", particles,
                                 groupsOf(particles, kGroup), most),
                     "simulate fewer particles"};
    }
    const Grid plan = planGrid(settings, particles);
    if (particles > buffers.particles || plan.cells() > buffers.cells) {
        Result<SimulationBuffers> made =
            createBuffers(device, std::max({particles, buffers.particles, kGroup}),
                          std::max(kFirstNeighbours, buffers.neighbours), std::max(plan.cells(), buffers.cells));
        if (!made) {
            return made.error();
        }
        if (keep_state) {
            if (Status copied = copyParticles(device, buffers, made.value(), counts.entries, odd); !copied) {
                return copied;
            }
        }
        buffers = std::move(made).value();
        kernels.bind(buffers, meshes, seen_by);
    }
    grid = plan;
    planned = std::max(particles, 1U);
    return {};
}

Status Solver::State::prepareBirths(double seconds) {
    counts.births = 0;
    if (settings.sources.emitters.empty()) {
        return {};
    }
    std::vector<Birth> births =
        birthsOf(settings.sources, settings.radius, settings.gravity, time, time + seconds, sources);
    const std::uint32_t most = settings.sources.most_particles;
    births.resize(std::min<std::size_t>(births.size(), most - std::min(most, counts.living)));
    const auto number = static_cast<std::uint32_t>(births.size());
    for (SourceBlock::Outlet& outlet : sources.outlets) {
        outlet.births[0] = std::min(outlet.births[0], number);
        outlet.births[1] = std::min(outlet.births[1], number);
    }
    // Half as many again. The number follows from the fluid's history and not from what the buffers held before: the
    // order of sums depends on the grid.
    if (const std::uint32_t needed = std::max(counts.entries, counts.living + number); needed > planned) {
        const std::uint32_t wanted = std::max(needed + needed / 2, 1024U);
        device.log(SLUICE_LOG_INFO, fmt::format("simulation: room for {} particles, now for {}", planned, wanted));
        if (Status grown = makeRoom(wanted, true); !grown) {
            return grown;
        }
    }
    if (number > buffers.births) {
        if (Status grown = growBirths(device, buffers, number + number / 2); !grown) {
            return grown;
        }
        kernels.bind(buffers, meshes, seen_by);
    }
    std::array<float, 8> record{};
    for (std::size_t i = 0; i < births.size(); ++i) {
        std::copy_n(births[i].position.begin(), 3, record.begin());
        std::copy_n(births[i].velocity.begin(), 3, record.begin() + 4);
        record[7] = static_cast<float>(births[i].fluid);
        std::memcpy(buffers[Slot::Births].mapped().data() + i * sizeof record, record.data(), sizeof record);
    }
    counts.births = number;
    return {};
}

}  // namespace sluice::vk
