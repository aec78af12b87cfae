// SPDX-License-Identifier: MIT
// Names and numbers: what is declared, and what the log speaks of without having declared it.
#include "sluice/ledger/object_use.hpp"
#include "state.hpp"

namespace sluice::ledger {
namespace {

/// The slot for a new object under `id`. Its predecessor keeps its own while events that are kept back mean it.
template <typename Object>
Slot takeSlot(std::deque<Object>& objects, IdMap& map, std::vector<Slot>& free, ObjectId id) {
    Slot slot = map.find(id);
    if (slot != kNoSlot && objects[slot].kept_back == 0) {
        objects[slot] = Object{};
        return slot;
    }
    if (slot != kNoSlot) {
        objects[slot].retired = true;
    }
    if (!free.empty()) {
        slot = free.back();
        free.pop_back();
        objects[slot] = Object{};
    } else {
        slot = static_cast<Slot>(objects.size());
        objects.emplace_back();
    }
    map.set(id, slot);
    return slot;
}

/// The slot of `id`; what the log speaks of without having declared it is declared here, as "`prefix`id".
template <typename Object>
Slot slotOf(IdMap& map, std::deque<Object>& objects, ObjectId id, const char* prefix) {
    if (const Slot known = map.find(id); known != kNoSlot) {
        return known;
    }
    const auto slot = static_cast<Slot>(objects.size());
    Object& fresh = objects.emplace_back();
    fresh.id = id;
    fresh.name = prefix + std::to_string(id);
    map.set(id, slot);
    return slot;
}

}  // namespace

void Ledger::declareActor(ActorId id, ActorKind kind, std::string_view name) {
    Actor& actor = state_->actor(id);
    // A number used again keeps its clock: the new actor is taken to begin when the old one has ended.
    actor.kind = kind;
    actor.name = name;
    actor.ended = false;
    actor.untold = actor.lost = false;
}

void Ledger::declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial,
                         std::uint16_t flags) {
    const Slot slot = takeSlot(state_->syncs, state_->sync_slots, state_->free_syncs, id);
    Sync& sync = state_->syncs[slot];
    sync.id = id;
    sync.kind = kind;
    sync.flags = flags;
    sync.name = name;
    sync.initial = sync.current = initial;
}

void Ledger::declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner) {
    const Slot old = state_->resource_slots.find(id);
    if (old != kNoSlot) {
        for (ReadMark& mark : state_->resources[old].reads) {
            state_->settleWitness(state_->resources[old], mark);
        }
    }
    const Slot slot = takeSlot(state_->resources, state_->resource_slots, state_->free_resources, id);
    Resource& resource = state_->resources[slot];
    resource.id = id;
    resource.name = name;
    resource.layout = layout;
    resource.owner = owner;
}

void Ledger::memoryFacts(ObjectId id, const MemoryFacts& facts) {
    state_->resources[state_->resourceSlot(id)].told = facts;
}

Actor& Ledger::State::actor(ActorId id) {
    const Slot slot = actor_slots.find(id);
    if (slot != kNoSlot) {
        return actors[slot];
    }
    Actor& fresh = actors.emplace_back();
    fresh.id = id;
    fresh.slot = static_cast<Slot>(actors.size() - 1);
    fresh.name = "actor " + std::to_string(id);
    actor_slots.set(id, fresh.slot);
    return fresh;
}

Slot Ledger::State::syncSlot(ObjectId id) {
    return slotOf(sync_slots, syncs, id, "sync ");
}

Slot Ledger::State::resourceSlot(ObjectId id) {
    return slotOf(resource_slots, resources, id, "resource ");
}

Slot Ledger::State::objectSlot(const Event& event) {
    switch (objectUse(event)) {
        case ObjectUse::Sync:
            return syncSlot(event.object);
        case ObjectUse::Resource:
            return resourceSlot(event.object);
        case ObjectUse::Actor:
            return actor(static_cast<ActorId>(event.object)).slot;
        case ObjectUse::None:
            break;
    }
    return kNoSlot;
}

void Ledger::State::keepBack(const Item& item) {
    if (std::uint32_t* count = keptBack(item)) {
        ++*count;
    }
}

void Ledger::State::letGo(const Item& item) {
    std::uint32_t* count = keptBack(item);
    if (count == nullptr || --*count != 0) {
        return;
    }
    if (objectUse(item.event) == ObjectUse::Sync ? syncs[item.slot].retired : resources[item.slot].retired) {
        (objectUse(item.event) == ObjectUse::Sync ? free_syncs : free_resources).push_back(item.slot);
    }
}

std::uint32_t* Ledger::State::keptBack(const Item& item) {
    if (item.slot == kNoSlot || item.event.kind == EventKind::Submit) {
        return nullptr;
    }
    return objectUse(item.event) == ObjectUse::Sync ? &syncs[item.slot].kept_back : &resources[item.slot].kept_back;
}

std::size_t Ledger::State::bytes() const {
    std::size_t sum = sizeof(State) + findings.capacity() * sizeof(Finding) + fds.size() * (sizeof(Fd) + 48) +
                      known.size() * (sizeof(Key) + 48);
    for (const Actor& actor : actors) {
        sum += sizeof(Actor) + actor.name.capacity() + actor.know.bytes() + actor.names.capacity() * sizeof(Named) +
               actor.queue.size() * sizeof(Item) + (actor.candidates ? sizeof *actor.candidates : 0) +
               (actor.gift ? sizeof(Gift) : 0);
    }
    for (const Sync& sync : syncs) {
        sum += sizeof(Sync) + sync.name.capacity() + sync.entries.capacity() * sizeof(Entry) +
               sync.uses.capacity() * sizeof(SyncUse);
        for (const Entry& entry : sync.entries) {
            sum += entry.know.bytes() + entry.everything.bytes() + entry.named.capacity() * sizeof(entry.named[0]);
        }
    }
    for (const Resource& resource : resources) {
        sum += sizeof(Resource) + resource.name.capacity() + resource.reads.capacity() * sizeof(ReadMark) +
               resource.forgiven.capacity() * sizeof(Forgiven) +
               resource.imports.capacity() * sizeof(resource.imports[0]);
    }
    return sum;
}

}  // namespace sluice::ledger
