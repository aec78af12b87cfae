// SPDX-License-Identifier: MIT
// The shared timeline: which value means what, who may touch an image when, and the host's end of every backend.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// Values of frame k >= 1; docs/protocol.md explains why they suffice.
[[nodiscard]] constexpr std::uint64_t gbufferWritten(std::uint64_t frame) { return 2 * frame - 1; }
[[nodiscard]] constexpr std::uint64_t compositeRead(std::uint64_t frame) { return 2 * frame; }
[[nodiscard]] constexpr std::uint64_t fluidWritten(std::uint64_t frame) { return frame; }
[[nodiscard]] constexpr std::uint32_t imageSetOf(std::uint64_t frame, std::uint32_t sets) {
    return static_cast<std::uint32_t>((frame - 1) % sets);
}

/// Who holds an image of a set, derived from the two counters alone.
enum class Holder : std::uint8_t {
    Host,            ///< may write GBuffer images, may read fluid images
    InFlightToRenderer, ///< given up by the host, not yet taken: nobody may touch it
    Renderer,        ///< may read GBuffer images, may write fluid images
    InFlightToHost
};

/// The protocol as a state machine for one image set, with no API in it. Each step returns an Error if it breaks the
/// protocol (value not increasing, step out of order, wrong side).
class HandOff {
  public:
    explicit HandOff(std::uint32_t image_set, std::uint32_t image_sets);

    [[nodiscard]] Status hostAcquire(std::uint64_t frame, std::uint64_t renderer_value);  ///< before the GBuffer is written
    [[nodiscard]] Status hostRelease(std::uint64_t frame);                                ///< signals gbufferWritten(frame)
    [[nodiscard]] Status rendererAcquire(std::uint64_t frame, std::uint64_t host_value);
    [[nodiscard]] Status rendererRelease(std::uint64_t frame);                            ///< signals fluidWritten(frame)
    [[nodiscard]] Status hostCompositeBegin(std::uint64_t frame, std::uint64_t renderer_value);
    [[nodiscard]] Status hostCompositeEnd(std::uint64_t frame);                           ///< signals compositeRead(frame)
    /// The renderer failed or was skipped for this frame: the host takes the set back without fluid.
    void abandon(std::uint64_t frame);
    [[nodiscard]] Holder holder() const { return holder_; }

  private:
    std::uint32_t set_;
    std::uint32_t sets_;
    std::uint64_t frame_ = 0;
    Holder holder_ = Holder::Host;
    bool compositing_ = false;
};

/// The GL command stream's end of the two timelines. One interface, one meaning, several backends (host_gl makes them).
/// Not thread-safe: used on the thread that owns the GL context.
class HostTimeline {
  public:
    HostTimeline() = default;
    HostTimeline(const HostTimeline&) = delete;
    HostTimeline& operator=(const HostTimeline&) = delete;
    virtual ~HostTimeline() = default;

    [[nodiscard]] virtual SluiceTimelineKind kind() const = 0;
    /// The host-to-renderer counter reaches `value` once every GL command issued before this call has completed.
    /// `textures` are the GL names whose contents must be visible to the renderer.
    [[nodiscard]] virtual Status signal(std::uint64_t value, std::span<const std::uint32_t> textures) = 0;
    /// GL commands issued after this call run after the renderer-to-host counter has reached `value`. CPU-side backends
    /// block up to `timeout_ns` and fail with SLUICE_TIMEOUT; GPU-side ones return at once.
    [[nodiscard]] virtual Status wait(std::uint64_t value, std::uint64_t timeout_ns,
                                      std::span<const std::uint32_t> textures) = 0;
};

}  // namespace sluice
