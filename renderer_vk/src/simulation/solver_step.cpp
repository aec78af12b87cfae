// SPDX-License-Identifier: MIT
// One step: its passes in order, and what becomes of it.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include "device/commands.hpp"
#include "device/one_shot.hpp"
#include "simulation/depth.hpp"
#include "simulation/solver_state.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kNotFinite = 1;  // FAULT_ of simulation.glsl
constexpr std::uint32_t kCrowded = 2;
constexpr std::uint32_t kScanGroup = 8;

}  // namespace

void Solver::State::run(VkCommandBuffer commands, Kernel kernel, std::uint32_t groups) {
    kernels.dispatch(commands, kernel, odd, groups);
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
                      VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    timer.mark(commands, kernelName(kernel));
}

void Solver::State::recordSearch(VkCommandBuffer commands) {
    const std::uint32_t entries = groupsOf(counts.entries, kGroup);
    const std::uint32_t blocks = groupsOf(groupsOf(grid.cells(), kScanBlock), kScanGroup);
    timer.begin(commands);
    if (settings.seen != nullptr) {
        memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT);
    }
    device.fn.vkCmdFillBuffer(commands, buffers[Slot::Cells].buffer(), 0, VK_WHOLE_SIZE, 0);
    device.fn.vkCmdFillBuffer(commands, buffers[Slot::Status].buffer(), 0, VK_WHOLE_SIZE, 0);
    if (changing()) {
        device.fn.vkCmdFillBuffer(commands, buffers[Slot::Blocked].buffer(), 0, VK_WHOLE_SIZE, 0);
    }
    if (!bodies.empty()) {
        device.fn.vkCmdFillBuffer(commands, buffers[Slot::Pushes].buffer(), 0, VK_WHOLE_SIZE, 0);
    }
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                  VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    timer.mark(commands, "clear");
    run(commands, Kernel::Predict, entries);
    run(commands, Kernel::ScanSums, blocks);
    run(commands, Kernel::ScanBlocks, 1);
    run(commands, Kernel::ScanCells, blocks);
    if (heldToDepth(settings)) {
        run(commands, Kernel::Depth, groupsOf(grid.columns(deepestAxis(settings)), kGroup));
    }
    run(commands, Kernel::Scatter, entries);
    run(commands, Kernel::Order, entries);
    run(commands, Kernel::Neighbours, groupsOf(counts.living, kGroup));
}

void Solver::State::record(VkCommandBuffer commands) {
    const std::uint32_t all = groupsOf(counts.living, kGroup);
    recordSearch(commands);
    for (std::uint32_t i = 0; i < settings.iterations; ++i) {
        run(commands, Kernel::Lambda, all);
        run(commands, Kernel::Delta, all);
    }
    run(commands, Kernel::Velocity, all);
    if (settings.vorticity > 0.0F) {
        run(commands, Kernel::Curl, all);
    }
    if (settings.tense()) {
        run(commands, Kernel::Surface, all);
    }
    run(commands, Kernel::Finish, all);
    if (changing()) {
        run(commands, Kernel::Retire, all);
        run(commands, Kernel::Born, groupsOf(counts.births, kGroup));
    }
    recordReadBack(commands);
}

void Solver::State::recordReadBack(VkCommandBuffer commands) {
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
    const VkBufferCopy whole{0, 0, sizeof(StepStatus)};
    device.fn.vkCmdCopyBuffer(commands, buffers[Slot::Status].buffer(), buffers.read_back.buffer(), 1, &whole);
    if (!bodies.empty()) {
        const VkBufferCopy pushes{0, sizeof(StepStatus), kPushBytes};
        device.fn.vkCmdCopyBuffer(commands, buffers[Slot::Pushes].buffer(), buffers.read_back.buffer(), 1, &pushes);
    }
    memoryBarrier(device, commands, VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

Result<StepStatus> Solver::State::tryStep(float dt) {
    const Parameters parameters =
        parametersOf(settings, grid, counts, buffers.stride(), buffers.neighbours, dt, moving);
    std::memcpy(buffers[Slot::Parameters].mapped().data(), &parameters, sizeof parameters);
    const BodyBlock block = bodyBlock(settings.bodies, moving);
    std::memcpy(buffers[Slot::Bodies].mapped().data(), &block, sizeof block);
    std::memcpy(buffers[Slot::Sources].mapped().data(), &sources, sizeof sources);
    // The host decides after every step whether it counts, so there is never more than one under way.
    if (const Status status = runOnce(device, [this](VkCommandBuffer commands) { record(commands); }); !status) {
        return status.error();
    }
    timer.collect();
    StepStatus status{};
    std::memcpy(&status, buffers.read_back.mapped().data(), sizeof status);
    return status;
}

Result<StepReport> Solver::State::attempt(double seconds) {
    measurable = searched = false;
    if (const Status ready = prepareBirths(seconds); !ready) {
        return ready.error();
    }
    moving = movedBodies(settings.bodies, bodies, walls, settings.gravity, time, seconds);
    for (;;) {
        const Result<StepStatus> tried = tryStep(static_cast<float>(seconds));
        if (!tried) {
            return tried.error();
        }
        const StepStatus& status = tried.value();
        if ((status.faults & kNotFinite) != 0) {
            return Error{SLUICE_ERROR_INTERNAL, "simulation",
                         fmt::format("a position or velocity became NaN or infinite in a step of {} s", seconds),
                         "the state is that before the step; take smaller velocities or forces"};
        }
        if ((status.faults & kCrowded) != 0) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation",
                         "more than 60000 particles lie within two supports of one place",
                         "the state is that before the step; spread the particles, or make their radius smaller"};
        }
        if (status.most_neighbours <= buffers.neighbours) {
            return StepReport{seconds,
                              double{std::bit_cast<float>(status.speed_bits)},
                              double{std::bit_cast<float>(status.move_bits)},
                              status.most_neighbours,
                              counts.births - status.stillborn,
                              status.stillborn,
                              status.gone,
                              depthOf(settings, grid, status.fullest)};
        }
        // The lists were cut short, so nothing of this step counts.
        const std::uint32_t rows = roomFor(status.most_neighbours);
        device.log(SLUICE_LOG_INFO,
                   fmt::format("simulation: lists of {} neighbours were too short, now {}", buffers.neighbours, rows));
        if (const Status grown = growLists(device, buffers, rows); !grown) {
            return grown.error();
        }
        kernels.bind(buffers, meshes, seen_by);
    }
}

void Solver::State::keep(const StepReport& report) {
    odd = !odd;
    measurable = true;
    for (std::size_t i = 0; i < moving.size(); ++i) {
        BodyPush push{};
        std::memcpy(&push, buffers.read_back.mapped().data() + sizeof(StepStatus) + i * sizeof push, sizeof push);
        const BodyImpulse impulse = impulseOf(push, settings, settings.bodies[i], report.seconds);
        pushBody(settings.bodies[i], moving[i], impulse.linear, impulse.angular, report.seconds);
    }
    bodies = moving;
    depth = report.depth;
    speed = std::max(report.speed, fastestPoint(settings.bodies, bodies));
    time += report.seconds;
    moved = counts.living;
    counts.entries = counts.living + counts.births;
    counts.living = counts.entries - report.blocked - report.drained;
    counts.next_identity += counts.births;
    counts.births = 0;
    for (const Emitter& emitter : settings.sources.emitters) {
        speed = std::max(speed, double{emitter.speed});  // of who may be born at any time
    }
}

}  // namespace sluice::vk
