// SPDX-License-Identifier: MIT
// How long each pass of a step took on the device.
#pragma once

#include <volk.h>

#include <string>
#include <utility>
#include <vector>

#include "device/device.hpp"

namespace sluice::vk {

/// Pinned; does nothing on a device without timestamps.
class StepTimer {
  public:
    explicit StepTimer(const Device& device);
    StepTimer(const StepTimer&) = delete;
    StepTimer& operator=(const StepTimer&) = delete;
    ~StepTimer();

    void begin(VkCommandBuffer commands);
    /// What ran since the last call was `name`.
    void mark(VkCommandBuffer commands, const char* name);
    /// After the commands have ended: adds their times to the sums.
    void collect();
    [[nodiscard]] const std::vector<std::pair<std::string, double>>& sums() const { return sums_; }

  private:
    const Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    std::vector<const char*> names_;
    std::vector<std::pair<std::string, double>> sums_;
};

}  // namespace sluice::vk
