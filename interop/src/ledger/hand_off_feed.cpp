// SPDX-License-Identifier: MIT
#include "sluice/ledger/hand_off_feed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "sluice/format.hpp"
#include "sluice/roles.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {

namespace {

constexpr std::uint32_t kGBufferRoles =
    SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_COLOUR) | SLUICE_ROLE_BIT(SLUICE_IMAGE_HOST_DEPTH);
constexpr std::uint64_t kGeneral = 1;  // VK_IMAGE_LAYOUT_GENERAL
constexpr std::uint64_t kGeneralToGeneral = kGeneral << 32U | kGeneral;

// Binary semaphores take numbers in turn. A frame has one of a kind and four frames are in flight at most.
constexpr ObjectId kFirstBinary = 16;
constexpr ObjectId kBinaries = 64;

// So many frames without a word of the queue: the renderer does not tell, and what waits for it would pile up.
constexpr std::uint64_t kPatienceFrames = 64;

std::uint64_t frameOf(std::uint64_t host_value) {
    return (host_value + 1) / 2;
}

}  // namespace

HandOffFeed::HandOffFeed(LiveLedger& ledger, SluiceTimelineKind kind, std::uint32_t image_sets)
    : ledger_(ledger), kind_(kind), sets_(image_sets) {
    held_.fill(true);
    ledger_.declareActor(kHostThread, ActorKind::HostThread, "host thread");
    ledger_.declareActor(kGlStream, ActorKind::GlContext, "GL stream");
    ledger_.declareActor(kRendererQueue, ActorKind::VulkanQueue, "renderer's queue");
    ledger_.declareSync(kSubmissions, SyncKind::Timeline, "submissions", 0, 0);
    ledger_.declareSync(kQueueDrains, SyncKind::Timeline, "renderer idle", 0, 0);
    ledger_.declareSync(kGlFinishes, SyncKind::Timeline, "calls of glFinish", 0, 0);
    if (kind_ == SLUICE_TIMELINE_BRIDGED) {
        ledger_.declareSync(kGlFences, SyncKind::Timeline, "GL fences", 0, 0);
        ledger_.declareActor(kBridgeThread, ActorKind::BridgeThread, "bridge thread");
    }
    if (kind_ != SLUICE_TIMELINE_BINARY) {
        const std::uint16_t flags = listed() ? kListedOnly : 0;
        ledger_.declareSync(kHostToRenderer, SyncKind::Timeline, "host-to-renderer", 0, flags);
        ledger_.declareSync(kRendererToHost, SyncKind::Timeline, "renderer-to-host", 0, flags);
    }
}

HandOffFeed::~HandOffFeed() {
    const std::lock_guard lock(mutex_);
    if (taken_ > 0 && !heard_) {
        queueUntold();
    }
    put(EventKind::ActorEnd, kRendererQueue, kNoObject, queue_frame_);
    if (kind_ == SLUICE_TIMELINE_BRIDGED) {
        put(EventKind::ActorEnd, kBridgeThread, kNoObject, submitted_);
    }
    put(EventKind::ActorEnd, kGlStream, kNoObject, submitted_);
    put(EventKind::ActorEnd, kHostThread, kNoObject, submitted_);
}

bool HandOffFeed::listed() const {
    return kind_ == SLUICE_TIMELINE_NATIVE || kind_ == SLUICE_TIMELINE_BINARY;
}

ObjectId HandOffFeed::syncOf(SluiceDirection direction, std::uint64_t value) const {
    if (kind_ == SLUICE_TIMELINE_BINARY) {
        return kFirstBinary + static_cast<ObjectId>(value % kBinaries) +
               (direction == SLUICE_HOST_TO_RENDERER ? 0 : kBinaries);
    }
    return direction == SLUICE_HOST_TO_RENDERER ? kHostToRenderer : kRendererToHost;
}

void HandOffFeed::put(EventKind kind, ActorId actor, ObjectId object, std::uint64_t frame, std::uint64_t value,
                      std::uint64_t begin_ns, std::uint64_t duration_ns, std::uint16_t flags) {
    if (blind_) {
        return;
    }
    Event event;
    event.kind = kind;
    event.actor = actor;
    event.object = object;
    event.frame = static_cast<std::uint32_t>(frame);
    event.value = value;
    event.time_ns = begin_ns != 0 ? begin_ns : monotonicNanoseconds();
    event.duration_ns = duration_ns;
    event.flags = flags;
    const bool transfer = kind == EventKind::Acquire || kind == EventKind::Release;
    event.aux = transfer                     ? kNoActor
                : kind == EventKind::Destroy ? static_cast<std::uint16_t>(ObjectClass::Resource)
                                             : std::uint16_t{0};
    ledger_.record(event);
}

void HandOffFeed::putImages(EventKind kind, ActorId actor, std::uint32_t roles, std::uint64_t frame,
                            std::uint64_t value, std::uint64_t begin_ns) {
    for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
        if ((roles & roles_ & SLUICE_ROLE_BIT(role)) != 0) {
            put(kind, actor, resourceOf(role, imageSetOf(frame, sets_)), frame, value, begin_ns);
        }
    }
}

void HandOffFeed::declareBinary(SluiceDirection direction, std::uint64_t value) {
    if (kind_ == SLUICE_TIMELINE_BINARY && !blind_) {
        const char* name = direction == SLUICE_HOST_TO_RENDERER ? "host-to-renderer" : "renderer-to-host";
        ledger_.declareSync(syncOf(direction, value), SyncKind::Binary, fmt::format("{} {}", name, value), 0,
                            kListedOnly);
    }
}

void HandOffFeed::imagesMade(std::uint32_t roles) {
    const std::lock_guard lock(mutex_);
    roles_ = roles;
    held_.fill(true);
    for (std::uint32_t set = 0; set < sets_; ++set) {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
            if ((roles & SLUICE_ROLE_BIT(role)) != 0 && !blind_) {
                ledger_.declareResource(
                    resourceOf(role, set),
                    fmt::format("{} of set {}", sluice::toString(static_cast<SluiceImageRole>(role)), set),
                    static_cast<std::uint32_t>(kGeneral), kGlStream);
            }
        }
    }
}

void HandOffFeed::imagesDestroyed(bool drained) {
    const std::lock_guard lock(mutex_);
    if (drained) {
        ++drains_;
        put(EventKind::Signal, kRendererQueue, kQueueDrains, queue_frame_, drains_);
        put(EventKind::Wait, kHostThread, kQueueDrains, queue_frame_, drains_);
    }
    for (std::uint32_t set = 0; set < sets_; ++set) {
        for (std::uint32_t role = 0; role < SLUICE_IMAGE_ROLE_COUNT; ++role) {
            if ((roles_ & SLUICE_ROLE_BIT(role)) != 0) {
                put(EventKind::Destroy, kHostThread, resourceOf(role, set), submitted_);
            }
        }
    }
    roles_ = 0;
}

void HandOffFeed::hostRecords(std::uint64_t frame) {
    put(EventKind::Submit, kHostThread, kGlStream, frame, frame);
}

void HandOffFeed::take(std::uint64_t frame) {
    bool& held = held_.at(imageSetOf(frame, sets_));
    if (!held) {
        putImages(EventKind::Acquire, kGlStream, roles_, frame, kGeneralToGeneral);
        held = true;
    }
}

void HandOffFeed::captureBegins(std::uint64_t frame) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Frame, kHostThread, kNoObject, frame, frame);
    put(EventKind::Frame, kGlStream, kNoObject, frame, frame);
    hostRecords(frame);
    take(frame);
    putImages(EventKind::Write, kGlStream, kGBufferRoles, frame, frame);
}

void HandOffFeed::captureEnds(std::uint64_t frame) {
    const std::lock_guard lock(mutex_);
    putImages(EventKind::Release, kGlStream, roles_, frame, kGeneralToGeneral);
    held_.at(imageSetOf(frame, sets_)) = false;
}

bool HandOffFeed::submits(std::uint64_t frame) {
    const std::lock_guard lock(mutex_);
    submitted_ = frame;
    ++unheard_;
    ++taken_;
    declareBinary(SLUICE_RENDERER_TO_HOST, frame);
    put(EventKind::Signal, kHostThread, kSubmissions, frame, frame);
    const bool patient = unheard_ <= kPatienceFrames || blind_;
    if (!patient) {
        queueUntold();
        blind_ = true;
    }
    return patient;
}

void HandOffFeed::takenBack(std::uint64_t frame) {
    const std::lock_guard lock(mutex_);
    if (submitted_ == frame) {
        unheard_ -= unheard_ > 0 ? 1 : 0;
        taken_ -= taken_ > 0 ? 1 : 0;
    }
    take(frame);
}

void HandOffFeed::compositeReads(std::uint64_t frame) {
    const std::lock_guard lock(mutex_);
    hostRecords(frame);
    take(frame);
    putImages(EventKind::Read, kGlStream, kAlwaysMadeFluidRoles, frame, frame);
}

void HandOffFeed::glSignals(std::uint64_t value, bool names_images) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t frame = frameOf(value);
    declareBinary(SLUICE_HOST_TO_RENDERER, value);
    putImages(EventKind::Names, kGlStream, names_images ? roles_ : 0, frame, kGeneral);
    put(EventKind::Signal, kGlStream, syncOf(SLUICE_HOST_TO_RENDERER, value), frame, value);
    signalled_ = std::max(signalled_, value);
}

void HandOffFeed::glWaits(std::uint64_t value, bool names_images) {
    const std::lock_guard lock(mutex_);
    hostRecords(value);
    putImages(EventKind::Names, kGlStream, names_images ? roles_ : 0, value, kGeneral);
    put(EventKind::Wait, kGlStream, syncOf(SLUICE_RENDERER_TO_HOST, value), value, value);
}

void HandOffFeed::fencePromised(std::uint64_t value) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Signal, kGlStream, kGlFences, frameOf(value), ++fences_);
    promised_ = std::max(promised_, value);
}

void HandOffFeed::bridgeWaited(std::uint64_t value, std::uint64_t begin_ns, bool arrived) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Wait, kBridgeThread, kGlFences, frameOf(value), ++bridged_, begin_ns,
        monotonicNanoseconds() - begin_ns, arrived ? std::uint16_t{0} : std::uint16_t{kTimedOut});
}

void HandOffFeed::bridgeSignals(std::uint64_t value) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Signal, kBridgeThread, syncOf(SLUICE_HOST_TO_RENDERER, value), frameOf(value), value);
    signalled_ = std::max(signalled_, value);
}

void HandOffFeed::glFinished(std::uint64_t begin_ns) {
    const std::lock_guard lock(mutex_);
    ++finishes_;
    hostRecords(submitted_);
    put(EventKind::Signal, kGlStream, kGlFinishes, 0, finishes_, begin_ns);
    put(EventKind::Wait, kHostThread, kGlFinishes, 0, finishes_, begin_ns, monotonicNanoseconds() - begin_ns);
}

void HandOffFeed::hostSignals(std::uint64_t value) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Signal, kHostThread, syncOf(SLUICE_HOST_TO_RENDERER, value), frameOf(value), value);
    signalled_ = std::max(signalled_, value);
}

void HandOffFeed::hostWaits(std::uint64_t value) {
    const std::lock_guard lock(mutex_);
    put(EventKind::WaitBegin, kHostThread, syncOf(SLUICE_RENDERER_TO_HOST, value), value, value);
}

void HandOffFeed::hostWaited(std::uint64_t value, std::uint64_t begin_ns, bool timed_out) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Wait, kHostThread, syncOf(SLUICE_RENDERER_TO_HOST, value), value, value, begin_ns,
        monotonicNanoseconds() - begin_ns, timed_out ? std::uint16_t{kTimedOut} : std::uint16_t{0});
}

void HandOffFeed::hostGaveUp(std::uint64_t value, std::uint64_t begin_ns) {
    const std::lock_guard lock(mutex_);
    put(EventKind::Wait, kHostThread, syncOf(SLUICE_RENDERER_TO_HOST, value), value, value, begin_ns,
        monotonicNanoseconds() - begin_ns, kGaveUp);
}

void HandOffFeed::queueUntold() {
    put(EventKind::ActorEnd, kRendererQueue, kNoObject, queue_frame_, 0, 0, 0, kUntold);
    if (!blind_) {
        ledger_.leaveUnchecked({queue_frame_ + 1, heard_ ? "the renderer told nothing more of its queue"
                                                         : "the renderer told nothing of its queue"});
    }
}

void HandOffFeed::queueBegins(std::uint64_t frame, std::uint64_t begin_ns) {
    if (frame == queue_frame_) {
        return;
    }
    queue_frame_ = frame;
    put(EventKind::Frame, kRendererQueue, kNoObject, frame, frame, begin_ns);
    put(EventKind::Wait, kRendererQueue, kSubmissions, frame, frame, begin_ns);
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

void HandOffFeed::trace(const SluiceTraceEvent& event) {
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
    switch (event.kind) {
        case SLUICE_TRACE_WAIT:
            put(EventKind::Wait, kRendererQueue, syncOf(SLUICE_HOST_TO_RENDERER, event.value), event.frame, event.value,
                event.begin_ns);
            return;
        case SLUICE_TRACE_ACQUIRE:
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
            unheard_ = 0;
            return;
        default:
            return;
    }
}

void HandOffFeed::rendererLost() {
    const std::lock_guard lock(mutex_);
    put(EventKind::ActorEnd, kRendererQueue, kNoObject, submitted_);
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
        return text + fmt::format("  frame {} has not been submitted; the last one is {}\n", value, submitted_);
    }
    text += fmt::format("  renderer's queue has frame {}, submitted to wait for host-to-renderer >= {}, which {} {}\n",
                        value, wanted, signalled_ >= wanted ? "has passed that with" : "has reached", signalled_);
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
