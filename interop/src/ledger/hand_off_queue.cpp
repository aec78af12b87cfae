// SPDX-License-Identifier: MIT
// The renderer's half of the feed: what its queue did, as its trace events tell it, late and in the queue's order.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "hand_off_roles.hpp"
#include "sluice/format.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {
namespace {

/// More than a simulation can hold at once; whoever tells of more is not believed.
constexpr std::uint32_t kMostDepths = 32;

}  // namespace

void HandOffFeed::queueUntold() {
    put(EventKind::ActorEnd, kRendererQueue, kNoObject, queue_frame_, 0, 0, 0, kUntold);
    if (!blind_) {
        ledger_.leaveUnchecked(
            {life_.frames_before + queue_frame_ + 1,
             heard_ ? "the renderer told nothing more of its queue" : "the renderer told nothing of its queue"});
    }
}

void HandOffFeed::queueBegins(std::uint64_t frame, std::uint64_t begin_ns) {
    if (frame == queue_frame_) {
        return;
    }
    queue_frame_ = frame;
    // Until its submission it had nothing to do, as far as this frame is concerned.
    const std::uint64_t since = std::min(std::max(queue_free_ns_, times(frame).begin_ns), begin_ns);
    put(EventKind::Frame, kRendererQueue, kNoObject, frame, frame, since);
    put(EventKind::Wait, kRendererQueue, kSubmissions, frame, frame, since);
}

void HandOffFeed::queueTouches(std::uint64_t frame, std::uint64_t begin_ns) {
    if (frame == touched_) {
        return;
    }
    touched_ = frame;
    // Which pass touches which image the renderer does not say. All lie between its acquires and its releases.
    putImages(EventKind::Read, kRendererQueue, kGBufferRoles, frame, frame, begin_ns);
    putImages(EventKind::Write, kRendererQueue, kFluidRoles, frame, frame, begin_ns);
}

void HandOffFeed::simulationMade(std::uint32_t slots) {
    const std::lock_guard lock(mutex_);
    if (blind_) {
        return;
    }
    if (slots_ == 0) {
        ledger_.declareActor(kSimulationQueue, ActorKind::VulkanQueue, life_.nameOf("simulation"));
        ledger_.declareSync(kFramesDone, SyncKind::Timeline, "frames that drew", 0, 0);
    }
    ledger_.declareSync(kSimulation, SyncKind::Timeline, "simulation", 0, 0);
    ledger_.declareSync(kDepthsFree, SyncKind::Timeline, "captured depths that are free", 0, 0);
    depths_.clear();
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
        // Buffers of both queues: nobody owns them, and they have no layout.
        ledger_.declareResource(slotResource(slot), fmt::format("output slot {}", slot), 0, kNoActor);
    }
    slots_ = slots;
}

bool HandOffFeed::depthTold(const SluiceTraceEvent& event) {
    const std::string_view name = event.name == nullptr ? std::string_view() : event.name;
    if (slots_ == 0 || !name.starts_with(kCapturedDepth)) {
        return false;
    }
    std::uint32_t number = 0;
    const std::size_t at = std::min(name.size(), kCapturedDepth.size() + 1);
    if (std::from_chars(name.data() + at, name.data() + name.size(), number).ec != std::errc{} ||
        number >= kMostDepths) {
        return true;
    }
    while (number >= depths_.size()) {
        // A buffer of both queues, as the output slots are.
        if (!blind_) {
            ledger_.declareResource(depthResource(static_cast<std::uint32_t>(depths_.size())),
                                    fmt::format("captured depth {}", depths_.size()), 0, kNoActor);
        }
        depths_.push_back(0);
    }
    const bool simulation = event.track == SLUICE_TRACK_SIMULATION;
    const bool acquire = event.kind == SLUICE_TRACE_ACQUIRE;
    const auto tell = [&](EventKind kind, ActorId actor, ObjectId object, std::uint64_t value) {
        put(kind, actor, object, event.frame, value, event.begin_ns);
    };
    if (simulation) {
        depths_[number] = acquire ? event.value : depths_[number];
        // Also as it lets go: until then every step has read it.
        tell(EventKind::Read, kSimulationQueue, depthResource(number), depths_[number]);
        if (!acquire) {
            tell(EventKind::Signal, kSimulationQueue, kDepthsFree, event.value);
        }
    } else if (!acquire) {
        tell(EventKind::Write, kRendererQueue, depthResource(number), event.value);
    } else if (event.value != 0) {
        tell(EventKind::Wait, kRendererQueue, kDepthsFree, event.value);
    }
    return true;
}

void HandOffFeed::simulationTold(const SluiceTraceEvent& event) {
    const std::lock_guard lock(mutex_);
    if (slots_ == 0 || depthTold(event)) {
        return;
    }
    switch (event.kind) {
        case SLUICE_TRACE_WAIT:
            put(EventKind::Wait, kSimulationQueue, kFramesDone, event.frame, event.value, event.begin_ns,
                event.duration_ns);
            return;
        case SLUICE_TRACE_RELEASE:
            put(EventKind::Write, kSimulationQueue, slotResource(event.value % slots_), event.frame, event.value,
                event.begin_ns);
            return;
        case SLUICE_TRACE_SIGNAL:
            put(EventKind::Signal, kSimulationQueue, kSimulation, event.frame, event.value, event.begin_ns);
            return;
        default:
            return;
    }
}

void HandOffFeed::trace(const SluiceTraceEvent& event) {
    if (event.track == SLUICE_TRACK_SIMULATION) {
        simulationTold(event);
        return;
    }
    if (event.track != SLUICE_TRACK_RENDERER_QUEUE || event.frame == 0) {
        return;
    }
    const std::lock_guard lock(mutex_);
    const auto image = [&]() -> std::uint32_t {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
            if (event.name != nullptr && sluice::toString(static_cast<SluiceImageRole>(role)) == event.name) {
                return SLUICE_ROLE_BIT(role);
            }
        }
        return 0;
    };
    heard_ = true;
    queueBegins(event.frame, event.begin_ns);
    if (depthTold(event)) {
        return;
    }
    switch (event.kind) {
        case SLUICE_TRACE_WAIT: {
            if (event.direction == SLUICE_SIMULATION_TO_RENDERER) {
                if (slots_ != 0) {
                    put(EventKind::Wait, kRendererQueue, kSimulation, event.frame, event.value, event.begin_ns);
                }
                return;
            }
            // It is told when the wait had ended: from its submission on the queue stood there.
            const std::uint64_t since =
                std::min(std::max(queue_free_ns_, times(event.frame).submitted_ns), event.begin_ns);
            put(EventKind::Wait, kRendererQueue, syncOf(SLUICE_HOST_TO_RENDERER, event.value), event.frame, event.value,
                since, event.begin_ns - since);
            return;
        }
        case SLUICE_TRACE_ACQUIRE:
            if (event.direction == SLUICE_SIMULATION_TO_RENDERER && slots_ != 0) {
                put(EventKind::Read, kRendererQueue, slotResource(event.value % slots_), event.frame, event.value,
                    event.begin_ns);
                return;
            }
            putImages(EventKind::Acquire, kRendererQueue, image(), event.frame, kGeneralToGeneral, event.begin_ns);
            return;
        case SLUICE_TRACE_PASS:
            queueTouches(event.frame, event.begin_ns);
            return;
        case SLUICE_TRACE_RELEASE:
            queueTouches(event.frame, event.begin_ns);
            putImages(EventKind::Release, kRendererQueue, image(), event.frame, kGeneralToGeneral, event.begin_ns);
            return;
        case SLUICE_TRACE_SIGNAL:
            put(EventKind::Signal, kRendererQueue, syncOf(SLUICE_RENDERER_TO_HOST, event.value), event.frame,
                event.value, event.begin_ns);
            if (slots_ != 0) {
                put(EventKind::Signal, kRendererQueue, kFramesDone, event.frame, event.value, event.begin_ns);
            }
            queue_free_ns_ = event.begin_ns;
            unheard_ = 0;
            return;
        default:
            return;
    }
}

void HandOffFeed::rendererLost() {
    const std::lock_guard lock(mutex_);
    put(EventKind::ActorEnd, kRendererQueue, kNoObject, submitted_);
    if (slots_ != 0) {
        put(EventKind::ActorEnd, kSimulationQueue, kNoObject, submitted_);
    }
}

std::string HandOffFeed::waitForChain(std::uint64_t value) const {
    const std::lock_guard lock(mutex_);
    if (blind_) {
        return "  unknown: the renderer does not tell what its queue does\n";
    }
    std::string text;
    for (const std::string& line : ledger_.waitChain(kHostThread)) {
        text += fmt::format("  {}\n", line);
    }
    // The renderer has not told of this frame yet; what it was submitted with is known all the same.
    const std::uint64_t wanted = gbufferWritten(value);
    if (value > submitted_) {
        return text + fmt::format("  frame {} has not been submitted; the last one is {}\n",
                                  life_.frames_before + value, submitted_ == 0 ? 0 : life_.frames_before + submitted_);
    }
    text += fmt::format("  renderer's queue has frame {}, submitted to wait for host-to-renderer >= {}, which {} {}\n",
                        life_.frames_before + value, wanted,
                        signalled_ >= wanted ? "has passed that with" : "has reached", signalled_);
    if (signalled_ >= wanted) {
        return text + "  so the renderer itself is late: its GPU work, or its device\n";
    }
    if (promised_ >= wanted) {
        return text + fmt::format(
                          "  bridge thread would signal {}, but waits for the GL fence of value {}; "
                          "GL stream has not come so far\n",
                          wanted, wanted);
    }
    return text + fmt::format("  nobody has promised host-to-renderer {}: its signal was never recorded\n", wanted);
}

}  // namespace sluice::ledger
