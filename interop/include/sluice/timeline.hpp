// SPDX-License-Identifier: MIT
// The shared timeline: which value means what, who may touch an image when, and the host's end of every backend.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice {

/// Values of frame k >= 1; docs/protocol.md explains why they suffice.
[[nodiscard]] constexpr std::uint64_t gbufferWritten(std::uint64_t frame) {
    return 2 * frame - 1;
}
[[nodiscard]] constexpr std::uint64_t compositeRead(std::uint64_t frame) {
    return 2 * frame;
}
[[nodiscard]] constexpr std::uint64_t fluidWritten(std::uint64_t frame) {
    return frame;
}
[[nodiscard]] constexpr std::uint32_t imageSetOf(std::uint64_t frame, std::uint32_t sets) {
    return static_cast<std::uint32_t>((frame - 1) % sets);
}

/// Who holds an image of a set, derived from the two counters alone.
enum class Holder : std::uint8_t {
    Host,                ///< may write GBuffer images, may read fluid images
    InFlightToRenderer,  ///< given up by the host, not yet taken: nobody may touch it
    Renderer,            ///< may read GBuffer images, may write fluid images
    InFlightToHost
};

/// The protocol as a state machine for one image set, with no API in it. Each step returns an Error if it breaks the
/// protocol (value not increasing, step out of order, wrong side) and then changes nothing.
class HandOff {
  public:
    explicit HandOff(std::uint32_t image_set, std::uint32_t image_sets);

    /// Before the GBuffer is written. Also legal when the fluid of an earlier frame was never composited (its wait
    /// timed out), once `renderer_value` has reached that frame.
    [[nodiscard]] Status hostAcquire(std::uint64_t frame, std::uint64_t renderer_value);
    [[nodiscard]] Status hostRelease(std::uint64_t frame);  ///< signals gbufferWritten(frame)
    [[nodiscard]] Status rendererAcquire(std::uint64_t frame, std::uint64_t host_value);
    [[nodiscard]] Status rendererRelease(std::uint64_t frame);  ///< signals fluidWritten(frame)
    [[nodiscard]] Status hostCompositeBegin(std::uint64_t frame, std::uint64_t renderer_value);
    [[nodiscard]] Status hostCompositeEnd(std::uint64_t frame);  ///< signals compositeRead(frame)
    /// The renderer failed or was skipped for this frame: the host takes the set back without fluid, and nobody waits
    /// for the frame's value. After rendererRelease the value is promised, so the next hostAcquire still needs it. A
    /// frame that is not the set's present or a later one of this set is ignored.
    void abandon(std::uint64_t frame);
    [[nodiscard]] Holder holder() const;

  private:
    enum class Step : std::uint8_t { Idle, Capture, InFlightToRenderer, Renderer, InFlightToHost, Composite };
    [[nodiscard]] Status expect(std::uint64_t frame, Step step, std::string_view call) const;
    [[nodiscard]] Error broken(std::uint64_t frame, std::string_view call, std::string detail) const;

    std::uint32_t set_;
    std::uint32_t sets_;
    std::uint64_t frame_ = 0;          ///< the frame that last used the set, 0 before the first
    std::uint64_t owed_renderer_ = 0;  ///< the renderer's counter must reach this before the host may write the set
    Step step_ = Step::Idle;
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
