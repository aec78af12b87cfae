// SPDX-License-Identifier: MIT
// NATIVE: one imported Vulkan timeline per direction (GL_NV_timeline_semaphore). Waits and signals are GPU commands.
#include <epoxy/gl.h>

#include <memory>
#include <utility>

#include "timeline/backends.hpp"
#include "timeline/gl_semaphore.hpp"
#include "timeline/timeline_events.hpp"

namespace sluice::host {

namespace {

class NativeTimeline final : public HostTimeline {
  public:
    NativeTimeline(TimelineDeps deps, GlSemaphore to_renderer, GlSemaphore to_host)
        : deps_(std::move(deps)), to_renderer_(std::move(to_renderer)), to_host_(std::move(to_host)) {}

    [[nodiscard]] SluiceTimelineKind kind() const override { return SLUICE_TIMELINE_NATIVE; }

    [[nodiscard]] Status signal(std::uint64_t value, std::span<const std::uint32_t> textures) override {
        const std::uint64_t begin = traceClock(deps_.trace);
        if (Status status = to_renderer_.setValue(value); !status) {
            return status;
        }
        Status status = signalRenderer(to_renderer_, value, begin, textures, deps_.trace);
        if (status && deps_.feed != nullptr) {
            deps_.feed->glSignals(value, !textures.empty());
        }
        return status;
    }

    [[nodiscard]] Status wait(std::uint64_t value, std::uint64_t /*timeout_ns*/,
                              std::span<const std::uint32_t> textures) override {
        const std::uint64_t begin = traceClock(deps_.trace);
        if (Status status = to_host_.setValue(value); !status) {
            return status;
        }
        Status status = waitForRenderer(to_host_, value, begin, textures, deps_.trace);
        if (status && deps_.feed != nullptr) {
            deps_.feed->glWaits(value, !textures.empty());
        }
        return status;
    }

  private:
    TimelineDeps deps_;
    GlSemaphore to_renderer_, to_host_;
};

}  // namespace

Result<std::unique_ptr<HostTimeline>> makeNativeTimeline(const TimelineDeps& deps) {
    const std::optional<NvTimelineFunctions> functions = loadNvTimelineFunctions();
    if (!functions || !epoxy_has_gl_extension("GL_EXT_semaphore") || !epoxy_has_gl_extension("GL_EXT_semaphore_fd")) {
        return Error{
            SLUICE_ERROR_UNSUPPORTED, "timeline native",
            functions ? "the GL driver has no GL_EXT_semaphore_fd" : "the GL driver has no GL_NV_timeline_semaphore",
            "request timeline 'auto' or 'bridged'"};
    }
    Result<GlSemaphore> to_renderer = GlSemaphore::import(deps, SLUICE_HOST_TO_RENDERER, 0, &*functions);
    if (!to_renderer) {
        return to_renderer.error();
    }
    Result<GlSemaphore> to_host = GlSemaphore::import(deps, SLUICE_RENDERER_TO_HOST, 0, &*functions);
    if (!to_host) {
        return to_host.error();
    }
    return std::unique_ptr<HostTimeline>(
        std::make_unique<NativeTimeline>(deps, std::move(to_renderer).value(), std::move(to_host).value()));
}

}  // namespace sluice::host
