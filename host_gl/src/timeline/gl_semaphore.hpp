// SPDX-License-Identifier: MIT
// A GL semaphore imported from a file descriptor (GL_EXT_semaphore_fd).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "sluice/result.hpp"
#include "timeline/host_timeline.hpp"

namespace sluice::host {

/// Functions of GL_NV_timeline_semaphore, which libepoxy does not know yet.
struct NvTimelineFunctions {
    void (*create)(std::int32_t count, std::uint32_t* semaphores);
    void (*parameteriv)(std::uint32_t semaphore, std::uint32_t name, const std::int32_t* values);
};
/// Empty if the driver lacks the extension or either function.
[[nodiscard]] std::optional<NvTimelineFunctions> loadNvTimelineFunctions();

/// Owns one imported semaphore. Move-only; freed with the GL context current.
class GlSemaphore {
  public:
    GlSemaphore() = default;
    GlSemaphore(GlSemaphore&& other) noexcept : semaphore_(std::exchange(other.semaphore_, 0)) {}
    GlSemaphore& operator=(GlSemaphore&& other) noexcept {
        std::swap(semaphore_, other.semaphore_);
        return *this;
    }
    GlSemaphore(const GlSemaphore&) = delete;
    GlSemaphore& operator=(const GlSemaphore&) = delete;
    ~GlSemaphore();

    /// That of (direction, value): a binary semaphore, or with `timeline` a timeline.
    [[nodiscard]] static Result<GlSemaphore> import(const TimelineDeps& deps, SluiceDirection direction,
                                                    std::uint64_t value, const NvTimelineFunctions* timeline);

    // Each fails with the name of the call and what GL raised; the host's own error flags are left as found.

    /// For timelines: the value of the next signal or wait.
    [[nodiscard]] Status setValue(std::uint64_t value) const;
    /// Every texture is in GL_LAYOUT_GENERAL_EXT on both sides. Flushes: only newer drivers do so by themselves.
    [[nodiscard]] Status signal(std::span<const std::uint32_t> textures) const;
    [[nodiscard]] Status wait(std::span<const std::uint32_t> textures) const;

  private:
    std::uint32_t semaphore_ = 0;
};

/// Signals value `value` to the renderer and records the step, which began at `begin`.
[[nodiscard]] Status signalRenderer(const GlSemaphore& semaphore, std::uint64_t value, std::uint64_t begin,
                                    std::span<const std::uint32_t> textures, Trace* trace);
/// The same for a wait for the renderer's value.
[[nodiscard]] Status waitForRenderer(const GlSemaphore& semaphore, std::uint64_t value, std::uint64_t begin,
                                     std::span<const std::uint32_t> textures, Trace* trace);

}  // namespace sluice::host
