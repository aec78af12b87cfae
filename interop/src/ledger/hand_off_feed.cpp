// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "hand_off_roles.hpp"
#include "sluice/format.hpp"
#include "sluice/roles.hpp"
#include "sluice/timeline.hpp"
#include "sluice/trace.hpp"

namespace sluice::ledger {

namespace {

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
    : ledger_(ledger), life_(ledger.rendererLife()), kind_(kind), sets_(image_sets) {
    held_.fill(true);
    ledger_.declareActor(kHostThread, ActorKind::HostThread, life_.nameOf("host thread"));
    ledger_.declareActor(kGlStream, ActorKind::GlContext, life_.nameOf("GL stream"));
    ledger_.declareActor(kRendererQueue, ActorKind::VulkanQueue, life_.nameOf("renderer's queue"));
    ledger_.declareSync(kSubmissions, SyncKind::Timeline, "submissions", 0, 0);
    ledger_.declareSync(kQueueDrains, SyncKind::Timeline, "renderer idle", 0, 0);
    ledger_.declareSync(kGlFinishes, SyncKind::Timeline, "calls of glFinish", 0, 0);
    if (kind_ == SLUICE_TIMELINE_BRIDGED) {
        ledger_.declareSync(kGlFences, SyncKind::Timeline, "GL fences", 0, 0);
        ledger_.declareSync(kPromises, SyncKind::Timeline, "fences for the bridge", 0, 0);
        ledger_.declareActor(kBridgeThread, ActorKind::BridgeThread, life_.nameOf("bridge thread"));
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
    if (slots_ != 0) {
        put(EventKind::ActorEnd, kSimulationQueue, kNoObject, queue_frame_);
    }
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
    event.frame = static_cast<std::uint32_t>(frame == 0 ? 0 : life_.frames_before + frame);
    event.value = kind == EventKind::Frame ? life_.frames_before + value : value;
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

void HandOffFeed::captureBegins(std::uint64_t frame, std::uint64_t draw_began_ns) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t now = monotonicNanoseconds();
    const std::uint64_t begin = draw_began_ns != 0 ? std::min(draw_began_ns, now) : now;
    times(frame) = {begin, 0};
    put(EventKind::Frame, kHostThread, kNoObject, frame, frame, begin);
    put(EventKind::Frame, kGlStream, kNoObject, frame, frame, begin);
    hostRecords(frame);  // the engine's draw and the capture
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
    times(frame).submitted_ns = monotonicNanoseconds();
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
    put(EventKind::Signal, kHostThread, kPromises, frameOf(value), fences_);
    promised_ = std::max(promised_, value);
}

void HandOffFeed::bridgeWaited(std::uint64_t value, std::uint64_t idle_ns, std::uint64_t begin_ns, bool arrived) {
    const std::lock_guard lock(mutex_);
    const std::uint64_t frame = frameOf(value);
    // What it slept before the frame began is no part of the frame.
    const std::uint64_t since = std::min(std::max(idle_ns, times(frame).begin_ns), begin_ns);
    ++bridged_;
    put(EventKind::Wait, kBridgeThread, kPromises, frame, bridged_, since, begin_ns - since);
    put(EventKind::Wait, kBridgeThread, kGlFences, frame, bridged_, begin_ns, monotonicNanoseconds() - begin_ns,
        arrived ? std::uint16_t{0} : std::uint16_t{kTimedOut});
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

}  // namespace sluice::ledger
