// SPDX-License-Identifier: MIT
#include "frame/frame_timer.hpp"

#include <cstring>
#include <utility>

#include "device/commands.hpp"
#include "device/structs.hpp"
#include "sluice/trace.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kFrameBegin = 0;
constexpr std::uint32_t kFrameEnd = 1;
constexpr std::uint32_t kFirstPass = 2;
constexpr std::uint32_t kQueries = kFirstPass + 2 * SLUICE_MAX_PASSES;

}  // namespace

std::uint64_t ticksToNanoseconds(std::uint64_t from, std::uint64_t to, std::uint32_t valid_bits, float period) {
    const std::uint64_t mask = valid_bits >= 64 ? UINT64_MAX : (std::uint64_t{1} << valid_bits) - 1;
    return static_cast<std::uint64_t>(static_cast<double>((to - from) & mask) * static_cast<double>(period));
}

FrameTimer::~FrameTimer() {
    device_.fn.vkDestroyQueryPool(device_.handle, pool_, nullptr);
}

Status FrameTimer::create() {
    if (device_.timestamp_valid_bits == 0) {
        return {};
    }
    auto info = vkStruct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = kQueries;
    if (const VkResult result = device_.fn.vkCreateQueryPool(device_.handle, &info, nullptr, &pool_);
        result != VK_SUCCESS) {
        return vulkanError(result, "vkCreateQueryPool");
    }
    BufferDesc desc;
    desc.size = kQueries * sizeof(std::uint64_t);
    desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    desc.place = BufferPlace::Readback;
    desc.name = "timestamps";
    Result<Buffer> results = Buffer::create(device_, desc);
    if (!results) {
        return results.error();
    }
    results_ = std::move(results).value();
    return {};
}

void FrameTimer::stamp(VkCommandBuffer commands, std::uint32_t query) const {
    if (pool_ != VK_NULL_HANDLE) {
        device_.fn.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, query);
    }
}

/// lavapipe bins a timestamp with the draws and resolves it at the next flush, but runs a dispatch at once: without
/// this barrier, which flushes, a dispatch would be over before its own begin is taken (seen: 0.06 ms for a pass of 15
/// ms). On other drivers it would only keep passes from overlapping, and hide from the validation layer that one of
/// them lacks a barrier of its own.
void FrameTimer::flush(VkCommandBuffer commands) const {
    memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0);
}

void FrameTimer::frameBegin(VkCommandBuffer commands) {
    labels_.clear();
    measuring_ = false;
    if (pool_ != VK_NULL_HANDLE) {
        device_.fn.vkCmdResetQueryPool(commands, pool_, 0, kQueries);
    }
    stamp(commands, kFrameBegin);
}

void FrameTimer::frameEnd(VkCommandBuffer commands) {
    stamp(commands, kFrameEnd);
    if (pool_ == VK_NULL_HANDLE) {
        return;
    }
    // On the device, because vkGetQueryPoolResults of lavapipe waits until the whole device is idle: with a later frame
    // in the queue that waits for a value which the host's thread has yet to give, that is for ever.
    const std::uint32_t count = kFirstPass + 2 * static_cast<std::uint32_t>(labels_.size());
    device_.fn.vkCmdCopyQueryPoolResults(commands, pool_, 0, count, results_.buffer(), 0, sizeof(std::uint64_t),
                                         VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
    memoryBarrier(device_, commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                  VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
}

void FrameTimer::begin(VkCommandBuffer commands, const PassLabel& label) {
    measuring_ = labels_.size() < SLUICE_MAX_PASSES;
    if (measuring_) {
        stamp(commands, kFirstPass + 2 * static_cast<std::uint32_t>(labels_.size()));
        if (device_.driver == VK_DRIVER_ID_MESA_LLVMPIPE && !device_.switches.no_timer_barrier) {
            flush(commands);
        }
        labels_.push_back(label);
    }
}

void FrameTimer::end(VkCommandBuffer commands) {
    if (measuring_) {
        stamp(commands, kFirstPass + 2 * static_cast<std::uint32_t>(labels_.size()) - 1);
        measuring_ = false;
    }
}

std::uint64_t FrameTimer::monotonicOf(std::uint64_t ticks, std::uint64_t last_ticks) const {
    const float period = device_.properties.limits.timestampPeriod;
    // Without calibration the frame is placed so that it ends when it is found finished.
    std::uint64_t reference_ticks = last_ticks;
    std::uint64_t reference_ns = 0;
    if (device_.features.calibrated_timestamps) {
        std::array<VkCalibratedTimestampInfoEXT, 2> domains{};
        domains[0] = vkStruct<VkCalibratedTimestampInfoEXT>(VK_STRUCTURE_TYPE_CALIBRATED_TIMESTAMP_INFO_EXT);
        domains[0].timeDomain = VK_TIME_DOMAIN_DEVICE_EXT;
        domains[1] = domains[0];
        domains[1].timeDomain = VK_TIME_DOMAIN_CLOCK_MONOTONIC_EXT;
        std::array<std::uint64_t, 2> now{};
        std::uint64_t deviation = 0;
        if (device_.fn.vkGetCalibratedTimestampsEXT(device_.handle, 2, domains.data(), now.data(), &deviation) ==
            VK_SUCCESS) {
            reference_ticks = now[0];
            reference_ns = now[1];
        }
    }
    if (reference_ns == 0) {
        reference_ns = monotonicNanoseconds();
    }
    return reference_ns - ticksToNanoseconds(ticks, reference_ticks, device_.timestamp_valid_bits, period);
}

FrameTimes FrameTimer::read() const {
    FrameTimes out;
    out.passes.resize(labels_.size());
    if (pool_ == VK_NULL_HANDLE) {
        return out;
    }
    std::array<std::uint64_t, kQueries> ticks{};
    std::memcpy(ticks.data(), results_.mapped().data(), sizeof(ticks));
    const float period = device_.properties.limits.timestampPeriod;
    const auto span = [&](std::uint32_t begin, std::uint32_t end) {
        return ticksToNanoseconds(ticks[begin], ticks[end], device_.timestamp_valid_bits, period);
    };
    const std::uint64_t start = monotonicOf(ticks[kFrameBegin], ticks[kFrameEnd]);
    out.frame = {start, span(kFrameBegin, kFrameEnd)};
    for (std::uint32_t i = 0; i < out.passes.size(); ++i) {
        const std::uint32_t first = kFirstPass + 2 * i;
        out.passes[i] = {start + span(kFrameBegin, first), span(first, first + 1)};
    }
    return out;
}

}  // namespace sluice::vk
