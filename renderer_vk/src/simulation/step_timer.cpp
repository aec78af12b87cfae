// SPDX-License-Identifier: MIT
#include "simulation/step_timer.hpp"

#include <algorithm>
#include <cstdint>

#include "device/structs.hpp"

namespace sluice::vk {
namespace {

constexpr std::uint32_t kQueries = 256;  // 64 iterations are 128 passes

}  // namespace

StepTimer::StepTimer(const Device& device) : device_(device) {
    if (device.timestamp_valid_bits == 0) {
        return;
    }
    auto info = vkStruct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = kQueries;
    if (device.fn.vkCreateQueryPool(device.handle, &info, nullptr, &pool_) != VK_SUCCESS) {
        pool_ = VK_NULL_HANDLE;  // times are a service: a simulation without them is still right
    }
}

StepTimer::~StepTimer() {
    device_.fn.vkDestroyQueryPool(device_.handle, pool_, nullptr);
}

void StepTimer::begin(VkCommandBuffer commands) {
    names_.clear();
    if (pool_ != VK_NULL_HANDLE) {
        device_.fn.vkCmdResetQueryPool(commands, pool_, 0, kQueries);
        device_.fn.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_, 0);
    }
}

void StepTimer::mark(VkCommandBuffer commands, const char* name) {
    if (pool_ != VK_NULL_HANDLE && names_.size() + 1 < kQueries) {
        names_.push_back(name);
        device_.fn.vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_,
                                        static_cast<std::uint32_t>(names_.size()));
    }
}

void StepTimer::collect() {
    if (names_.empty()) {
        return;
    }
    std::vector<std::uint64_t> ticks(names_.size() + 1);
    if (device_.fn.vkGetQueryPoolResults(device_.handle, pool_, 0, static_cast<std::uint32_t>(ticks.size()),
                                         ticks.size() * 8, ticks.data(), 8, VK_QUERY_RESULT_64_BIT) != VK_SUCCESS) {
        return;
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
        const double ms =
            static_cast<double>(ticks[i + 1] - ticks[i]) * double{device_.properties.limits.timestampPeriod} * 1e-6;
        const auto found =
            std::find_if(sums_.begin(), sums_.end(), [&](const auto& sum) { return sum.first == names_[i]; });
        if (found == sums_.end()) {
            sums_.emplace_back(names_[i], ms);
        } else {
            found->second += ms;
        }
    }
}

}  // namespace sluice::vk
