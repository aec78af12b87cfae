// SPDX-License-Identifier: MIT
// The ordering ledger: one happens-before graph over GL contexts, Vulkan queues, threads and processes, kept as vector
// clocks (Mattern 1989), with epochs for accesses so that the common case is O(1) (FastTrack, Flanagan and Freund
// 2009). Pure C++: neither GL nor Vulkan.
//
// Order that the ledger knows:
// - program order within an actor;
// - Submit: what a thread did before it happens before what it gave to a stream;
// - Signal to Wait of one sync object. A timeline's wait for v is satisfied by the first signal of at least v, and
//   inherits that signal and all lower ones. A binary's wait consumes its signal. A fence's wait leaves it signalled.
// A Wait on a kListedOnly sync orders execution as always, but makes visible only what both lists name.
//
// Events may arrive before the signal that they wait for (wait-before-signal): an actor whose next event is a Wait that
// nothing satisfies yet is held there, and what it did later is judged when the wait is satisfied.
//
// Threads: one at a time. LiveLedger (live.hpp) is what several threads may write to.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/ledger/event.hpp"
#include "sluice/ledger/finding.hpp"

namespace sluice::ledger {

struct LedgerOptions {
    std::uint64_t max_timeline_gap = 0x7FFFFFFF;  ///< maxTimelineSemaphoreValueDifference
    std::uint64_t useless_wait_ns = 0;            ///< useless and over-waits cheaper than this are not told
    std::size_t max_findings = 10000;             ///< further ones are counted, not kept
    bool performance = true;                      ///< tell useless-wait and over-wait
    /// Signals of one sync that are kept before those are looked for that may be forgotten. The verdict does not depend
    /// on it: 2 in tests looks often, SIZE_MAX never.
    std::size_t prune_above = 64;
    /// Events that wait behind an actor that stands still. Beyond them it is lost: nothing more of it, nor of what it
    /// feeds, is judged, and unheard() says so.
    std::size_t max_held = 100'000;
};

/// An actor for which findings() does not speak, at all or from a frame on.
struct Unheard {
    ActorId actor = kNoActor;
    std::uint32_t since_frame = 0;  ///< 0: from the first
    std::string why;                ///< "renderer's queue: ..."
};

/// An actor that stands still, for the watchdog and for the end of a log.
struct Blocked {
    ActorId actor;
    ObjectId sync;
    std::uint64_t value;
    std::uint64_t since_ns;
};

/// How the log ended, for judging the waits that are still open.
enum class End : std::uint8_t {
    Closed,     ///< everybody has ended: what is missing will never come
    Truncated,  ///< the log was cut: what is missing may yet have come
};

class Ledger {
  public:
    explicit Ledger(LedgerOptions options = {});
    Ledger(Ledger&&) noexcept;
    Ledger& operator=(Ledger&&) noexcept;
    ~Ledger();

    // Names. Ids are the caller's, dense from 0; declaring one anew starts a new object under the old number.
    void declareActor(ActorId id, ActorKind kind, std::string_view name);
    void declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial, std::uint16_t flags);
    void declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner);
    /// The facts of the memory that the next Export or Import event of `id` speaks of.
    void memoryFacts(ObjectId id, const MemoryFacts& facts);

    /// Each actor's own events in its own order; between actors any order that the log has. An id that was never
    /// declared is declared on the spot as "actor 3", "sync 5".
    void record(const Event& event);

    /// Judges what is still open: blocked waits, open fds. record() must not follow.
    void finish(End end);

    [[nodiscard]] const std::vector<Finding>& findings() const;
    [[nodiscard]] std::uint64_t findingsDropped() const;
    /// Contexts and queues that were declared and did nothing, actors whose end says that they were not told, and those
    /// that stood still for too long.
    [[nodiscard]] std::vector<Unheard> unheard() const;
    [[nodiscard]] std::vector<Blocked> blocked() const;
    /// Who waits for whom from `actor` on, one line each, with names and values: "queue waits for host-to-renderer >=
    /// 7, which has reached 5; gl context would signal it, but waits for ...".
    [[nodiscard]] std::vector<std::string> waitChain(ActorId actor) const;
    [[nodiscard]] std::uint64_t eventsSeen() const;
    /// Bytes held; bounded in a run without end by forgetting signals that every actor has already seen.
    [[nodiscard]] std::size_t memoryBytes() const;

    [[nodiscard]] std::string actorName(ActorId id) const;
    [[nodiscard]] std::string syncName(ObjectId id) const;
    [[nodiscard]] std::string resourceName(ObjectId id) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace sluice::ledger
