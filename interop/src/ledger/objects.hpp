// SPDX-License-Identifier: MIT
// What the ledger remembers of actors, sync objects, resources and descriptors.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "clock.hpp"
#include "sluice/ledger/ledger.hpp"

namespace sluice::ledger {

inline constexpr Slot kNoSlot = 0xFFFFFFFF;

/// Ids of the log to slots. Small ids cost an index; a hostile log's huge ones cost a map entry, not an array up to
/// there.
class IdMap {
  public:
    [[nodiscard]] Slot find(std::uint32_t id) const {
        if (id < kDense) {
            return id < dense_.size() ? dense_[id] : kNoSlot;
        }
        const auto found = sparse_.find(id);
        return found == sparse_.end() ? kNoSlot : found->second;
    }
    void set(std::uint32_t id, Slot slot) {
        if (id >= kDense) {
            sparse_[id] = slot;
            return;
        }
        if (id >= dense_.size()) {
            dense_.resize(id + 1, kNoSlot);
        }
        dense_[id] = slot;
    }

  private:
    static constexpr std::uint32_t kDense = 1U << 16U;
    std::vector<Slot> dense_;
    std::unordered_map<std::uint32_t, Slot> sparse_;
};

/// A resource in the list of a signal or a wait.
struct Named {
    Slot resource;
    std::uint32_t layout;
    Event event;
};

/// A signal that has been given.
struct Entry {
    std::uint64_t value = 0;
    Knowledge know;                             ///< of this signal and, on a timeline, all lower ones
    Clock everything;                           ///< kListedOnly: what signals without any list make visible
    std::vector<std::pair<Slot, Clock>> named;  ///< kListedOnly: what the listed ones make visible, by resource
    Epoch by;
    Event signal;
};

/// The last time that an actor signalled or waited for a sync.
struct SyncUse {
    Epoch at;
    Event last;
    bool signalled = false, waited = false;
    std::uint64_t waited_value = 0;
    std::uint64_t met_value = 0;  ///< of the signal that let it go: higher where signals between were forgotten
};

struct Sync {
    ObjectId id = kNoObject;
    SyncKind kind = SyncKind::Timeline;
    std::uint16_t flags = 0;
    std::string name;
    std::uint64_t initial = 0, current = 0;
    std::uint64_t forced = 0;    ///< highest value that a watchdog gave
    std::vector<Entry> entries;  ///< ascending values; a binary or a fence has at most one
    std::size_t prune_at = 0;
    std::vector<SyncUse> uses;  ///< one per actor
    std::vector<Slot> waiters;  ///< actors held here
    std::optional<Event> consumed, destroyed;
    Epoch consumed_at;
    std::uint32_t kept_back = 0;  ///< events of held actors that mean it
    bool retired = false;         ///< declared anew meanwhile
    bool blamed = false;          ///< a finding already explains why a wait on it hangs

    [[nodiscard]] bool listedOnly() const { return (flags & kListedOnly) != 0; }
};

/// The last read of a resource by one actor.
struct ReadMark {
    Epoch at;
    Event event;
    bool active = true;            ///< no write has followed
    bool broken = false;           ///< the model has something against it
    bool lucky = false;            ///< namely an order or a visibility that is missing: right pixels were luck
    bool raced_input = false;      ///< what was read was made from something that its maker had in a race
    std::optional<Event> witness;  ///< its pixels, while a write that races with it may still turn up
};

/// An order that a reported race is taken to have had, so that it is told once: `before` happened before `after`.
struct Forgiven {
    Epoch before, after;
};

struct Release {
    Event event;
    Epoch at;
    std::uint32_t old_layout, new_layout;
};

/// A race that has been told while its edge may still get a better name: the signal, or the release, comes later in
/// the log than the access that should have waited for it.
struct OpenRace {
    std::size_t finding = 0;
    ObjectId resource = kNoObject;
    std::string name;  ///< of the resource
    Epoch at;          ///< of `early`
    Event early, late;
    Slot waiting = 0;              ///< the actor of `late`
    bool release_to_come = false;  ///< `early` is what leads to the release that `late` should have come after
};

/// A missing edge in words.
struct EdgeText {
    std::string edge;
    bool certain = false;  ///< the late side waits for that very sync elsewhere; only then the rest counts
    std::string waiter, signaller, awaited;
};

/// After a race that the log shows the wrong way round: until `actor` comes after `until`, what it does to the
/// resource is older than what the ledger has seen of it.
struct Behind {
    Slot actor = kNoSlot;
    Epoch until;
    Epoch last = {};  ///< and its last use of that kind
    Event last_event = {};
};

struct Resource {
    ObjectId id = kNoObject;
    std::string name;
    std::uint32_t kept_back = 0;  ///< events of held actors that mean it
    bool retired = false;         ///< declared anew meanwhile
    std::uint32_t layout = 0;     ///< 0: not known
    Event layout_event;
    ActorId owner = kNoActor;  ///< kNoActor: free
    std::optional<Release> release;
    std::optional<Release>
        retaken;  ///< its owner took back what nobody else has acquired: that may have been too early
    std::optional<Behind> behind;
    Epoch write_at;  ///< last write, transition or transfer
    Event write_event;
    std::optional<Event> content;  ///< last Write
    bool raced_input = false;      ///< of that content: its maker had a race in the same frame, or read such content
    std::vector<ReadMark> reads;   ///< one per actor
    std::vector<Forgiven> forgiven;
    std::optional<Event> destroyed;
    std::optional<MemoryFacts> told;  ///< for the next Export or Import
    std::optional<std::pair<Event, MemoryFacts>> exported;
    std::vector<std::pair<Event, MemoryFacts>> imports;  ///< that came before the export
};

/// The order that a Submit gives, when submitter or stream is held.
struct Ticket {
    bool done = false;
    Knowledge know;
    Slot submitter = kNoSlot, stream = kNoSlot;
    std::uint64_t candidate = 0;
};

/// An event that has to wait for its actor's turn.
struct Item {
    Event event;
    Slot slot = kNoSlot;             ///< of event.object, as it was when the event came
    std::shared_ptr<Ticket> ticket;  ///< of a Submit, or with `join` of what the submission waits for
    bool join = false;
};

/// A thread's wait that may turn out to have been a stream's business.
struct Candidate {
    std::uint64_t serial = 0;  ///< 0: none
    Event signal, wait;
    Slot sync = kNoSlot;
    Clock before, after;
    bool used = false, excused = false;
    Slot stream = kNoSlot;
};

/// What a stream owes to a thread's wait: `without` is what it would know had the thread not submitted after it.
struct Gift {
    Slot thread = kNoSlot;
    std::uint64_t candidate = 0;
    Clock without;
};

struct Actor {
    ActorId id = kNoActor;
    Slot slot = kNoSlot;
    ActorKind kind = ActorKind::HostThread;
    std::string name;
    bool ended = false;
    bool untold = false;  ///< kUntold
    std::uint64_t tick = 1;
    Knowledge know;  ///< of others; its own past goes without saying
    std::uint32_t frame = 0;
    std::optional<std::uint32_t> raced_in;  ///< the last frame in which what it read may have been wrong
    std::uint64_t told = 0;                 ///< events, its end left out
    bool lost = false;                      ///< stood still for too long: nothing more of it is judged
    std::string lost_at;                    ///< where
    std::uint32_t lost_since = 0;           ///< frame
    std::vector<Named> names;
    std::vector<Slot> fed_by;  ///< who has submitted to it
    std::deque<Item> queue;    ///< not empty: held at its front
    std::optional<Item> open_wait;
    std::unique_ptr<std::array<Candidate, 8>> candidates;
    std::uint64_t newest_candidate = 0;
    std::unique_ptr<Gift> gift;

    [[nodiscard]] bool isThread() const { return kind == ActorKind::HostThread || kind == ActorKind::BridgeThread; }
    [[nodiscard]] bool after(Epoch epoch) const { return epoch.actor == slot || know.order().covers(epoch); }
    [[nodiscard]] Epoch now() const { return {slot, tick}; }
};

}  // namespace sluice::ledger
