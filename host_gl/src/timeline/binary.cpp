// SPDX-License-Identifier: MIT
// BINARY: one imported binary semaphore per value (GL_EXT_semaphore_fd), never reused: reuse has stalled drivers.
#include <epoxy/gl.h>

#include <memory>
#include <utility>

#include "timeline/backends.hpp"
#include "timeline/gl_semaphore.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

class BinaryTimeline final : public HostTimeline {
  public:
    explicit BinaryTimeline(TimelineDeps deps) : deps_(std::move(deps)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_BINARY; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> textures) override {
        // Nobody waits for even values (docs/protocol.md), and a binary semaphore must be waited for exactly once.
        if (value % 2 == 0) {
            glFlush();
            return {};
        }
        const std::uint64_t begin = traceClock(deps_.trace);
        Result<GlSemaphore> semaphore = GlSemaphore::import(deps_, SLUICE_HOST_TO_RENDERER, value, nullptr);
        if (!semaphore) {
            return semaphore.error();
        }
        Status status = signalRenderer(semaphore.value(), value, begin, textures, deps_.trace);
        if (status && deps_.feed != nullptr) {
            deps_.feed->glSignals(value, !textures.empty());
        }
        return status;
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t /*timeout_ns*/,
                              std::span<const std::uint32_t> textures) override {
        // The GL stream is in order: what has waited for a higher value has waited for this one.
        if (value <= waited_) {
            return {};
        }
        const std::uint64_t begin = traceClock(deps_.trace);
        Result<GlSemaphore> semaphore = GlSemaphore::import(deps_, SLUICE_RENDERER_TO_HOST, value, nullptr);
        if (!semaphore) {
            return semaphore.error();
        }
        Status status = waitForRenderer(semaphore.value(), value, begin, textures, deps_.trace);
        if (status && deps_.feed != nullptr) {
            deps_.feed->glWaits(value, !textures.empty());
        }
        waited_ = status ? value : waited_;
        return status;
    }

    /// Imports the semaphores of the first frame and lets go of them: whether the two drivers understand each other.
    /// The ledger hears of these, and of no frame's.
    [[nodiscard]] Status trial() {
        for (const SluiceDirection direction : {SLUICE_HOST_TO_RENDERER, SLUICE_RENDERER_TO_HOST}) {
            if (Result<GlSemaphore> semaphore = GlSemaphore::import(deps_, direction, 1, nullptr); !semaphore) {
                return semaphore.error();
            }
        }
        deps_.shares = nullptr;
        return {};
    }

  private:
    TimelineDeps deps_;
    std::uint64_t waited_ = 0;
};

}  // namespace

Result<std::unique_ptr<HostTimeline>> makeBinaryTimeline(const TimelineDeps& deps) {
    for (const char* extension : {"GL_EXT_semaphore", "GL_EXT_semaphore_fd"}) {
        if (!epoxy_has_gl_extension(extension)) {
            return Error{SLUICE_ERROR_UNSUPPORTED, "timeline binary", std::string("the GL driver has no ") + extension,
                         "request timeline 'auto' or 'bridged'"};
        }
    }
    auto timeline = std::make_unique<BinaryTimeline>(deps);
    if (Status status = timeline->trial(); !status) {
        return status.error();
    }
    return std::unique_ptr<HostTimeline>(std::move(timeline));
}

}  // namespace sluice::host
