// SPDX-License-Identifier: MIT
// The ledger's inside, split over files by subject.
#pragma once

#include <cstdint>
#include <map>
#include <tuple>

#include "objects.hpp"

namespace sluice::ledger {

struct Ledger::State {
    LedgerOptions options;
    std::deque<Actor> actors;  // deques, so that references stay good
    std::deque<Sync> syncs;
    std::deque<Resource> resources;
    IdMap actor_slots, sync_slots, resource_slots;
    std::vector<Slot> free_syncs, free_resources;  ///< of objects that were declared anew
    std::vector<Slot> runnable;                    ///< held actors whose front may have become possible
    std::uint64_t events = 0;
    std::uint64_t candidate_serial = 0;

    enum class FdState : std::uint8_t { Open, Given, Closed };
    struct Fd {
        FdState state;
        Event last;
    };
    std::map<ObjectId, Fd> fds;

    std::vector<OpenRace> open_races;  ///< told, but not yet what should have been waited for; few
    std::vector<Finding> findings;
    std::uint64_t dropped = 0;
    using Key = std::tuple<FindingKind, ObjectId, ActorId, EventKind, ActorId, EventKind>;
    std::map<Key, std::size_t> known;

    // ledger.cpp: declarations, flow of events
    Actor& actor(ActorId id);
    Slot syncSlot(ObjectId id);
    Slot resourceSlot(ObjectId id);
    Slot objectSlot(const Event& event);
    void record(Event event);
    void submit(Actor& from, Item item);
    bool execute(Actor& by, Item& item);
    void hold(Actor& who, Item item);
    void lose(Actor& who);

    // declare.cpp: objects that events of held actors still mean
    void keepBack(const Item& item);
    void letGo(const Item& item);
    [[nodiscard]] std::uint32_t* keptBack(const Item& item);
    void runHeld();
    [[nodiscard]] std::size_t bytes() const;

    // sync.cpp
    void signal(Actor& by, const Item& item);
    bool wait(Actor& by, const Item& item);
    void publish(Actor& by, Knowledge& into);
    void fillEntry(Actor& by, Sync& sync, Entry& entry, const Event& event, const std::vector<Named>& names);
    bool absorbEntry(Actor& by, const Sync& sync, const Entry& entry, const std::vector<Named>& names);
    static SyncUse& useOf(Sync& sync, const Actor& by, const Event& event);

    // prune.cpp
    void prune(Sync& sync);

    // access.cpp
    void access(Actor& by, const Item& item);
    bool againstWrite(Actor& by, Resource& resource, Slot slot, const Event& event);
    bool againstReads(Actor& by, Resource& resource, const Event& event);
    void witness(Actor& by, const Item& item);
    void settleWitness(Resource& resource, ReadMark& mark);

    // race.cpp
    void race(FindingKind kind, Actor& by, Resource& resource, Epoch at, const Event& first, const Event& second);
    void tellRace(const OpenRace& one, const EdgeText& missing);
    /// The release that a race's early side was still to make.
    void releasedLate(const Actor& by, const Resource& resource, const Event& event);
    /// A signal that came after a race was told may be the one that should have been waited for.
    void nameEdges(const Sync& sync, const Entry& entry);
    /// What `late` should have waited for to come after `at`, best guess first.
    [[nodiscard]] EdgeText missingEdge(Epoch at, const Event& first, const Actor& late, const Event& second,
                                       const std::string& what) const;
    /// Who would have to wait for `sync` so that `late` comes after it: itself, a thread that feeds it, or nullptr.
    [[nodiscard]] const Actor* waiterFor(const Sync& sync, const Actor& late) const;

    // ownership.cpp
    void checkOwner(Actor& by, Resource& resource, const Event& event);
    void release(Actor& by, Resource& resource, const Event& event);
    void acquire(Actor& by, Resource& resource, const Event& event);
    void layoutChange(Resource& resource, const Event& event);
    void namedAtSignal(Actor& by, const std::vector<Named>& names);
    void namedAtWait(const std::vector<Named>& names);
    void layoutMismatch(Resource& resource, const Event& event, std::uint32_t named);

    // lifetime.cpp
    void descriptor(const Event& event);
    void memory(const Event& event, Resource& resource);
    void compareMemory(const Resource& resource, const std::pair<Event, MemoryFacts>& imported);
    void destroy(Actor& by, const Item& item);
    void leakedDescriptors();

    // cost.cpp
    void uselessWait(const Actor& by, const Sync& sync, const Entry& entry, const SyncUse& use, const Event& event);
    [[nodiscard]] bool mayBeOverWait(const Actor& by, const Event& event) const;
    void threadWaited(Actor& by, Slot sync, const Entry& entry, const Event& event, Clock before);
    void threadSignalled(Actor& by);
    void needed(Actor& by, Epoch epoch);
    void gift(const Actor& from, std::uint64_t candidate, Actor& stream);
    void judge(Actor& thread, Candidate& candidate);

    // waits.cpp
    struct Link {
        const Actor* actor;
        const Item* wait;  ///< a Wait or WaitBegin, or a join with its ticket
    };
    [[nodiscard]] const Item* standsAt(const Actor& who) const;
    [[nodiscard]] const Actor* wouldSatisfy(const Actor& who, const Item& wait) const;
    [[nodiscard]] std::vector<Link> follow(const Actor& who, bool& cycle) const;
    [[nodiscard]] std::vector<std::string> chainLines(const Actor& who) const;
    [[nodiscard]] bool satisfied(const Item& wait) const;
    [[nodiscard]] bool somebodyLeft(const Actor& who, const Sync& sync) const;
    /// Its signals may have come without being told.
    [[nodiscard]] bool untold(const Sync& sync) const;
    void judgeWaits(End end);

    // report.cpp
    /// The finding to fill in, or nullptr when it was known before or there are too many.
    Finding* report(FindingKind kind, ObjectId object, const Event& first, const Event& second, std::uint64_t cost = 0);
    [[nodiscard]] std::string name(ActorId id) const;
    [[nodiscard]] std::string syncText(const Sync& sync, std::uint64_t value) const;
};

/// "reads", "acquires"
[[nodiscard]] std::string verb(EventKind kind);
/// "write of version 3", "release"
[[nodiscard]] std::string accessText(const Event& event);

}  // namespace sluice::ledger
