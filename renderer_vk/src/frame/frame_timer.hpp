// SPDX-License-Identifier: MIT
// Timestamps around the passes of one frame, and where they lie on CLOCK_MONOTONIC.
#pragma once

#include <volk.h>

#include <array>
#include <cstdint>
#include <vector>

#include "device/device.hpp"
#include "frame/pass_context.hpp"
#include "memory/buffer.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// A span of device time on CLOCK_MONOTONIC, in nanoseconds. Zero if the device has no timestamps.
struct GpuSpan {
    std::uint64_t begin_ns = 0;
    std::uint64_t duration_ns = 0;
};

/// What a finished frame measured.
struct FrameTimes {
    GpuSpan frame;
    std::vector<GpuSpan> passes;  ///< as many as labels()
};

/// One per image set; used again once the set's frame has finished. A frame has at most SLUICE_MAX_PASSES passes; what
/// comes after those is not measured and not counted.
class FrameTimer final : public PassTimer {
  public:
    explicit FrameTimer(const Device& device) : device_(device) {}
    FrameTimer(const FrameTimer&) = delete;
    FrameTimer& operator=(const FrameTimer&) = delete;
    ~FrameTimer() override;
    [[nodiscard]] Status create();

    void frameBegin(VkCommandBuffer commands);
    void frameEnd(VkCommandBuffer commands);
    void begin(VkCommandBuffer commands, const PassLabel& label) override;
    void end(VkCommandBuffer commands) override;

    [[nodiscard]] const std::vector<PassLabel>& labels() const { return labels_; }
    /// Only when the frame has finished.
    [[nodiscard]] FrameTimes read() const;

  private:
    void stamp(VkCommandBuffer commands, std::uint32_t query) const;
    void flush(VkCommandBuffer commands) const;
    [[nodiscard]] std::uint64_t monotonicOf(std::uint64_t ticks, std::uint64_t last_ticks) const;

    const Device& device_;
    VkQueryPool pool_ = VK_NULL_HANDLE;
    Buffer results_;  ///< ticks by query, filled at the end of the frame
    std::vector<PassLabel> labels_;
    bool measuring_ = false;
};

/// Nanoseconds between two timestamps of a counter with `valid_bits` bits that may have wrapped once.
[[nodiscard]] std::uint64_t ticksToNanoseconds(std::uint64_t from, std::uint64_t to, std::uint32_t valid_bits,
                                               float period);

}  // namespace sluice::vk
