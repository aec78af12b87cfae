// SPDX-License-Identifier: MIT
// What a solver tells of each particle's surroundings once its steps are done.
#include <fmt/format.h>
#include <shaders/simulation_anisotropy_comp.h>

#include <array>
#include <cstring>
#include <span>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "simulation/solver_state.hpp"

namespace sluice::vk {
namespace {

struct AnisotropyPush {
    std::uint32_t entries, moved;
    float ratio, smoothing, lonely;
    std::uint32_t placed;
};

/// Parameters, two views of texels, then storage buffers.
constexpr auto kAnisotropyBindings = [] {
    std::array<VkDescriptorType, 9> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    types[0] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    types[1] = types[2] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    return types;
}();

}  // namespace

Status checkAnisotropy(const Anisotropy& how) {
    // Negated so that NaN fails as well.
    if (!(how.ratio >= 1.0F && how.ratio <= kMostStretched)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "anisotropy",
                     fmt::format("a ratio of {} is out of range", how.ratio),
                     fmt::format("give 1 to {}", kMostStretched)};
    }
    if (!(how.smoothing >= 0.0F && how.smoothing <= 1.0F) || !(how.lonely > 0.0F && how.lonely <= 1.0F)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "anisotropy",
                     fmt::format("smoothing {} or lonely {} is out of range", how.smoothing, how.lonely),
                     "give 0 to 1, and above 0 to 1"};
    }
    return {};
}

Status Solver::State::search() {
    if (measurable || searched || counts.living == 0) {
        return {};
    }
    StepCounts now = counts;
    now.births = 0;
    for (;;) {
        Parameters parameters = parametersOf(settings, grid, now, buffers.stride(), buffers.neighbours, 1.0F, bodies);
        parameters.gravity[3] = 0.0F;  // nothing moves
        std::memcpy(buffers[Slot::Parameters].mapped().data(), &parameters, sizeof parameters);
        const BodyBlock block = bodyBlock(settings.bodies, bodies);
        std::memcpy(buffers[Slot::Bodies].mapped().data(), &block, sizeof block);
        std::memcpy(buffers[Slot::Sources].mapped().data(), &sources, sizeof sources);
        if (Status status = runOnce(device,
                                    [this](VkCommandBuffer commands) {
                                        recordSearch(commands);
                                        recordReadBack(commands);
                                    });
            !status) {
            return status;
        }
        timer.collect();
        StepStatus status{};
        std::memcpy(&status, buffers.read_back.mapped().data(), sizeof status);
        if (status.faults != 0) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                         "more than 60000 particles lie within two supports of one place",
                         "spread the particles, or make their radius smaller"};
        }
        if (status.most_neighbours <= buffers.neighbours) {
            searched = true;
            return {};
        }
        if (Status grown = growLists(device, buffers, roomFor(status.most_neighbours)); !grown) {
            return grown;
        }
        kernels.bind(buffers, meshes, seen_by);
    }
}

Surroundings Solver::State::surroundings() const {
    if (measurable) {
        return {buffers[odd ? Slot::PositionOut : Slot::PositionIn].buffer(),
                buffers[odd ? Slot::IdentityOut : Slot::IdentityIn].buffer(), counts.entries, moved};
    }
    // In and Out have not changed places: the search has sorted the state into Out, and kept it.
    return {buffers[Slot::Sorted].buffer(), buffers[odd ? Slot::IdentityIn : Slot::IdentityOut].buffer(), counts.living,
            counts.living};
}

Status Solver::State::runTimed(const std::function<void(VkCommandBuffer)>& record) {
    Status done = runOnce(device, [&](VkCommandBuffer commands) {
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                      VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                          VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
        timer.begin(commands);
        record(commands);
    });
    if (done) {
        timer.collect();
    }
    return done;
}

Status Solver::ellipsoids(const Anisotropy& how, VkBuffer to, const PlaceBuffers& places) {
    State& s = *state_;
    if (Status status = checkAnisotropy(how); !status) {
        return status;
    }
    if (Status status =
            buildOnce(s.device, s.anisotropy,
                      {"anisotropy", simulation_anisotropy_comp, kAnisotropyBindings, sizeof(AnisotropyPush), {}});
        !status) {
        return status;
    }
    if (Status status = s.search(); !status) {
        return status;
    }
    const Surroundings around = s.surroundings();
    if (around.entries == 0) {
        return {};
    }
    const std::array bindings{
        PassBinding{kAnisotropyBindings[0], s.buffers[Slot::Parameters].buffer()},
        PassBinding{kAnisotropyBindings[1], VK_NULL_HANDLE, s.texels(Slot::Sorted)},
        PassBinding{kAnisotropyBindings[2], VK_NULL_HANDLE, s.texels(Slot::List)},
        PassBinding{kAnisotropyBindings[3], s.buffers[Slot::ListCount].buffer()},
        PassBinding{kAnisotropyBindings[4], around.position},
        PassBinding{kAnisotropyBindings[5], around.identity},
        PassBinding{kAnisotropyBindings[6], to},
        // What is not read has a stand-in.
        PassBinding{kAnisotropyBindings[7], places ? places.marks : around.identity},
        PassBinding{kAnisotropyBindings[8], places ? places.before : around.identity},
    };
    s.anisotropy.bind(bindings);
    const AnisotropyPush push{around.entries, around.moved, how.ratio, how.smoothing, how.lonely, places ? 1U : 0U};
    return s.runTimed([&](VkCommandBuffer commands) {
        s.anisotropy.dispatch(commands, std::as_bytes(std::span(&push, 1)), groupsOf(around.entries, kGroup));
        s.timer.mark(commands, "anisotropy");
    });
}

}  // namespace sluice::vk
