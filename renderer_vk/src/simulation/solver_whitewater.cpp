// SPDX-License-Identifier: MIT
// Where a solver's water turns white.
#include <fmt/format.h>
#include <shaders/simulation_whitewater_comp.h>

#include <array>
#include <span>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "simulation/solver_state.hpp"

namespace sluice::vk {
namespace {

/// Mirrors whitewater.comp.
struct Push {
    Whitewater how;
    std::uint32_t entries, moved, placed;
};
static_assert(sizeof(Push) == 36, "the shader's block has no padding");

/// Parameters, three views of texels, then storage buffers.
constexpr auto kBindings = [] {
    std::array<VkDescriptorType, 11> types{};
    types.fill(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    types[0] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    types[1] = types[2] = types[3] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    return types;
}();

}  // namespace

Status checkWhitewater(const Whitewater& how) {
    for (const WhitewaterRange& range : {how.air, how.crest, how.energy}) {
        if (!(range.low >= 0.0F && range.low < range.high && range.high < 1e9F)) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "whitewater",
                         fmt::format("{} to {} is no range", range.low, range.high),
                         "give two numbers from 0 on, the second above the first"};
        }
    }
    return {};
}

Status Solver::whitewater(const Whitewater& how, VkBuffer to, const PlaceBuffers& places) {
    State& s = *state_;
    if (Status status = checkWhitewater(how); !status) {
        return status;
    }
    if (!s.measurable) {  // nothing has moved yet
        return runOnce(s.device, [&](VkCommandBuffer commands) {
            s.device.fn.vkCmdFillBuffer(commands, to, 0, VK_WHOLE_SIZE, 0);
        });
    }
    if (Status status =
            buildOnce(s.device, s.whitewater, {"whitewater", simulation_whitewater_comp, kBindings, sizeof(Push), {}});
        !status) {
        return status;
    }
    const Surroundings around = s.surroundings();
    if (around.entries == 0) {
        return {};
    }
    const std::array bindings{
        PassBinding{kBindings[0], s.buffers[Slot::Parameters].buffer()},
        PassBinding{kBindings[1], VK_NULL_HANDLE, s.texels(Slot::Sorted)},
        PassBinding{kBindings[2], VK_NULL_HANDLE, s.texels(Slot::List)},
        PassBinding{kBindings[3], VK_NULL_HANDLE, s.texels(Slot::Walls)},
        PassBinding{kBindings[4], s.buffers[Slot::ListCount].buffer()},
        PassBinding{kBindings[5], around.position},
        PassBinding{kBindings[6], onDevice().velocity},
        PassBinding{kBindings[7], around.identity},
        PassBinding{kBindings[8], to},
        // What is not read has a stand-in.
        PassBinding{kBindings[9], places ? places.marks : around.identity},
        PassBinding{kBindings[10], places ? places.before : around.identity},
    };
    s.whitewater.bind(bindings);
    const Push push{how, around.entries, around.moved, places ? 1U : 0U};
    return s.runTimed([&](VkCommandBuffer commands) {
        s.run(commands, Kernel::Surface, groupsOf(around.moved, kGroup));
        s.whitewater.dispatch(commands, std::as_bytes(std::span(&push, 1)), groupsOf(around.entries, kGroup));
        s.timer.mark(commands, "whitewater");
    });
}

}  // namespace sluice::vk
