// SPDX-License-Identifier: MIT
// What a Sluice host tells the ledger: the hand-off of docs/protocol.md as events, one method per step that was really
// taken. A wait that was left out leaves no Wait.
//
// Actors: the host's thread, the GL command stream that it records, the bridge's thread, the renderer's queue. The
// renderer's CPU side runs inside the host's calls, so it is the host's thread.
//
// The renderer tells of its queue late (when a frame is polled) but in the queue's order, so a submission is a signal
// of its own and no Submit event: by the time that the queue's events of frame k arrive the host may have submitted
// frame k+1, and what it knew then is not what frame k was given.
//
// A simulation inside the renderer is an actor of its own, that signals its timeline and writes output slots. It waits
// for frames by the renderer's timeline; here that is a counter of its own, since the images' one makes only listed
// images visible where OpenGL waits for it. It reads the depths that frames capture for it, each buffer of them a
// resource of its own; that such a buffer is free again the host's thread sees under a mutex, which is a counter, too.
//
// Submissions, GL fences, calls of glFinish and of the renderer until it is idle are counted, and each of the counters
// is a timeline: that says as much as an object for each, and the ledger forgets what is past.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/ledger/live.hpp"
#include "sluice/plugin.h"

namespace sluice::ledger {

inline constexpr ActorId kHostThread = 0, kGlStream = 1, kRendererQueue = 2, kBridgeThread = 3, kSimulationQueue = 4;
inline constexpr ObjectId kHostToRenderer = 0, kRendererToHost = 1, kSubmissions = 2, kGlFences = 3, kGlFinishes = 4,
                          kQueueDrains = 5, kPromises = 6, kSimulation = 7, kFramesDone = 8, kDepthsFree = 9;

/// The resource that stands for a shared image.
[[nodiscard]] constexpr ObjectId resourceOf(std::uint32_t role, std::uint32_t image_set) {
    return image_set * SLUICE_MAX_IMAGE_ROLES + role;
}

/// The resource that stands for an output slot of the simulation.
[[nodiscard]] constexpr ObjectId slotResource(std::uint64_t slot) {
    return resourceOf(0, SLUICE_MAX_IMAGE_SETS) + static_cast<ObjectId>(slot);
}

/// The resource that stands for a buffer that depths are captured into.
[[nodiscard]] constexpr ObjectId depthResource(std::uint32_t number) {
    return slotResource(SLUICE_MAX_FRAMES_IN_FLIGHT + 1) + number;
}

/// Any thread. `begin_ns` is CLOCK_MONOTONIC; the other events are given the time of the call.
class HandOffFeed {
  public:
    /// `kind`: what renderer and host have settled on. The ledger must outlive the feed. Frames are told as the
    /// renderer counts them; the ledger gets them with those before its rendererLife() added, as the host counts.
    HandOffFeed(LiveLedger& ledger, SluiceTimelineKind kind, std::uint32_t image_sets);
    HandOffFeed(const HandOffFeed&) = delete;
    HandOffFeed& operator=(const HandOffFeed&) = delete;
    /// Nobody of the hand-off will signal any more: renderer, bridge and timelines are gone.
    ~HandOffFeed();

    /// The images of every set are new; `roles` are SLUICE_ROLE_BITs. The host has them.
    void imagesMade(std::uint32_t roles);
    /// The images are gone. GL had been finished before. `drained`: and the renderer had waited for its queue.
    void imagesDestroyed(bool drained);

    /// The renderer has a simulation, the first or another; value v lies in slot v mod `slots`.
    void simulationMade(std::uint32_t slots);

    // Host's side, in the order of a frame. Frame k uses set (k-1) mod N.

    /// GL takes the images if it has given them away, and writes version `frame` of the GBuffer.
    /// `draw_began_ns`: when the engine began to draw that frame, 0 when nobody says; for the times of a log.
    void captureBegins(std::uint64_t frame, std::uint64_t draw_began_ns = 0);
    /// GL gives the images away; the signal comes next.
    void captureEnds(std::uint64_t frame);
    /// submit_frame is about to be called. False once: the renderer has told nothing of its queue for many frames, and
    /// from here on nothing is recorded.
    [[nodiscard]] bool submits(std::uint64_t frame);
    /// Nobody has taken the images of `frame`: the signal or submit_frame failed, and they are GL's again.
    void takenBack(std::uint64_t frame);
    /// GL takes the images if it has given them away, and reads version `frame` of the fluid.
    void compositeReads(std::uint64_t frame);

    // Signals and waits, as the timelines do them.

    /// GL records a signal or a wait of its own. `names_images`: the call lists every texture of the value's set.
    void glSignals(std::uint64_t value, bool names_images);
    void glWaits(std::uint64_t value, bool names_images);
    /// GL records a fence that stands for `value`.
    void fencePromised(std::uint64_t value);
    /// The bridge, idle since `idle_ns`, has waited for that fence from `begin_ns` on; `arrived`: not in vain.
    void bridgeWaited(std::uint64_t value, std::uint64_t idle_ns, std::uint64_t begin_ns, bool arrived);
    void bridgeSignals(std::uint64_t value);
    /// glFinish has returned.
    void glFinished(std::uint64_t begin_ns);
    /// The host's thread signals the renderer itself.
    void hostSignals(std::uint64_t value);
    /// The host's thread begins to wait for the renderer, and has ended that wait.
    void hostWaits(std::uint64_t value);
    void hostWaited(std::uint64_t value, std::uint64_t begin_ns, bool timed_out);
    /// The host's thread has left that wait before its end, for a cause that is told elsewhere.
    void hostGaveUp(std::uint64_t value, std::uint64_t begin_ns);

    /// What the renderer says of its queue; all else is passed over.
    void trace(const SluiceTraceEvent& event);
    /// The renderer's device is lost: its queue signals nothing more.
    void rendererLost();

    /// Who waits for whom while the host's thread waits for the renderer's `value`, a line each.
    [[nodiscard]] std::string waitForChain(std::uint64_t value) const;

  private:
    [[nodiscard]] bool listed() const;
    [[nodiscard]] ObjectId syncOf(SluiceDirection direction, std::uint64_t value) const;
    void put(EventKind kind, ActorId actor, ObjectId object, std::uint64_t frame, std::uint64_t value = 0,
             std::uint64_t begin_ns = 0, std::uint64_t duration_ns = 0, std::uint16_t flags = 0);
    void putImages(EventKind kind, ActorId actor, std::uint32_t roles, std::uint64_t frame, std::uint64_t value,
                   std::uint64_t begin_ns = 0);
    void declareBinary(SluiceDirection direction, std::uint64_t value);
    void hostRecords(std::uint64_t frame);
    void take(std::uint64_t frame);
    /// The renderer does not tell what its queue does: what waits for it cannot be judged.
    void queueUntold();
    void queueBegins(std::uint64_t frame, std::uint64_t begin_ns);
    void queueTouches(std::uint64_t frame, std::uint64_t begin_ns);
    void simulationTold(const SluiceTraceEvent& event);
    /// Whether it is of a captured depth: then all is told that there is to tell.
    bool depthTold(const SluiceTraceEvent& event);

    /// What is remembered of a frame in flight, for the times of events that are told later.
    struct FrameTimes {
        std::uint64_t begin_ns = 0, submitted_ns = 0;
    };
    FrameTimes& times(std::uint64_t frame) { return times_[frame % times_.size()]; }

    LiveLedger& ledger_;
    RendererLife life_;
    SluiceTimelineKind kind_;
    std::uint32_t sets_;
    mutable std::mutex mutex_;  // guards all below, and that each actor's events come in its own order
    std::uint32_t roles_ = 0;
    std::array<bool, SLUICE_MAX_IMAGE_SETS> held_{};  ///< GL has the images
    std::uint64_t promised_ = 0;                      ///< highest value that a GL fence stands for
    std::uint64_t signalled_ = 0;                     ///< highest value of host to renderer
    std::uint64_t submitted_ = 0;                     ///< frame
    std::uint64_t queue_frame_ = 0;                   ///< the frame that the queue's events are in
    std::uint64_t touched_ = 0;                       ///< the last frame whose passes have been told
    std::uint64_t finishes_ = 0, fences_ = 0, drains_ = 0;
    std::array<FrameTimes, 8> times_{};  ///< twice as many as there can be image sets
    std::uint64_t queue_free_ns_ = 0;    ///< when the queue had ended the last frame that it told of
    std::uint64_t bridged_ = 0;          ///< fences that the bridge has waited for, in their order
    std::uint64_t unheard_ = 0;          ///< submissions since the queue's last signal
    std::uint64_t taken_ = 0;            ///< submissions that did not fail
    std::uint32_t slots_ = 0;            ///< of the simulation, 0: there is none
    std::vector<std::uint64_t> depths_;  ///< by buffer that depths are captured into: the frame that the fluid reads
    bool heard_ = false;                 ///< the queue was, at least once
    bool blind_ = false;
};

}  // namespace sluice::ledger
