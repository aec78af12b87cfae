// SPDX-License-Identifier: MIT
// The public face, and the flow of events: an actor whose next event is not possible yet is held, all others go on.
#include "sluice/ledger/ledger.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {

void Ledger::State::record(Event event) {
    ++events;
    Actor& by = actor(event.actor);
    if (event.kind == EventKind::Frame) {
        by.frame = static_cast<std::uint32_t>(event.value);
        return;
    }
    if (event.frame == 0) {
        event.frame = by.frame;
    }
    // At once, even for an actor that is held.
    by.untold |= event.kind == EventKind::ActorEnd && (event.flags & kUntold) != 0;
    by.told += event.kind == EventKind::ActorEnd ? 0U : 1U;
    if (by.lost) {
        return;
    }
    Item item{event, objectSlot(event), nullptr, false};
    switch (event.kind) {
        // Not part of the order: judged as they come, even from an actor that is held.
        case EventKind::FdOpen:
        case EventKind::FdGive:
        case EventKind::FdClose:
            return descriptor(event);
        case EventKind::Export:
        case EventKind::Import:
            return memory(event, resources[item.slot]);
        case EventKind::Submit:
            submit(by, std::move(item));
            break;
        default:
            if (!by.queue.empty() || !execute(by, item)) {
                hold(by, std::move(item));
            }
    }
    if (!runnable.empty()) {
        runHeld();
    }
}

bool Ledger::State::execute(Actor& by, Item& item) {
    const Event& event = item.event;
    if (item.join) {
        if (!item.ticket->done) {
            return false;
        }
        gift(actors[item.ticket->submitter], item.ticket->candidate, by);
        by.know.absorb(item.ticket->know);
        return true;
    }
    switch (event.kind) {
        case EventKind::Signal:
            signal(by, item);
            return true;
        case EventKind::Wait:
            return wait(by, item);
        case EventKind::WaitBegin:
            by.open_wait = item;
            return true;
        case EventKind::Submit:
            publish(by, item.ticket->know);
            item.ticket->candidate = by.newest_candidate;
            item.ticket->done = true;
            runnable.push_back(item.ticket->stream);
            return true;
        case EventKind::Read:
        case EventKind::Write:
        case EventKind::Release:
        case EventKind::Acquire:
        case EventKind::Layout:
            access(by, item);
            return true;
        case EventKind::Names:
            by.names.push_back({item.slot, static_cast<std::uint32_t>(event.value), event});
            return true;
        case EventKind::Destroy:
            destroy(by, item);
            return true;
        case EventKind::Witness:
            witness(by, item);
            return true;
        case EventKind::ActorEnd:
            by.ended = true;
            return true;
        default:
            return true;
    }
}

void Ledger::State::submit(Actor& from, Item item) {
    Actor& stream = actors[item.slot];
    if (&stream == &from) {
        return;
    }
    if (stream.lost) {
        return;
    }
    if (std::find(stream.fed_by.begin(), stream.fed_by.end(), from.slot) == stream.fed_by.end()) {
        stream.fed_by.push_back(from.slot);
    }
    if (from.queue.empty() && stream.queue.empty()) {
        gift(from, from.newest_candidate, stream);
        from.know.raise(from.now());
        ++from.tick;
        stream.know.absorb(from.know);
        return;
    }
    item.ticket = std::make_shared<Ticket>();
    item.ticket->submitter = from.slot;
    item.ticket->stream = stream.slot;
    Item join{item.event, item.slot, item.ticket, true};
    if (!from.queue.empty()) {
        hold(from, std::move(item));
    } else {
        execute(from, item);
    }
    hold(stream, std::move(join));
}

void Ledger::State::hold(Actor& who, Item item) {
    if (who.lost) {
        return;
    }
    keepBack(item);
    who.queue.push_back(std::move(item));
    if (who.queue.size() > options.max_held) {
        lose(who);
    }
}

/// What it fed would be judged without the order of its submissions, so that is lost with it. What waits for its
/// signals stands still, and in the end is lost as well.
void Ledger::State::lose(Actor& who) {
    const std::vector<std::string> chain = chainLines(who);
    who.lost = true;
    who.lost_at = chain.empty() ? std::string("stands still") : chain.front();
    who.lost_since = who.queue.empty() ? who.frame : who.queue.front().event.frame;
    for (const Item& item : who.queue) {
        letGo(item);
    }
    who.queue.clear();
    who.queue.shrink_to_fit();
    for (Actor& stream : actors) {
        if (!stream.lost && std::find(stream.fed_by.begin(), stream.fed_by.end(), who.slot) != stream.fed_by.end()) {
            lose(stream);
        }
    }
}

void Ledger::State::runHeld() {
    while (!runnable.empty()) {
        Actor& who = actors[runnable.back()];
        runnable.pop_back();
        while (!who.queue.empty() && execute(who, who.queue.front())) {
            letGo(who.queue.front());
            who.queue.pop_front();
        }
    }
}

Ledger::Ledger(LedgerOptions options) : state_(std::make_unique<State>()) {
    state_->options = options;
}
Ledger::Ledger(Ledger&&) noexcept = default;
Ledger& Ledger::operator=(Ledger&&) noexcept = default;
Ledger::~Ledger() = default;

void Ledger::record(const Event& event) {
    state_->record(event);
}

void Ledger::finish(End end) {
    state_->judgeWaits(end);
    for (Resource& resource : state_->resources) {
        for (ReadMark& mark : resource.reads) {
            state_->settleWitness(resource, mark);
        }
    }
    for (Actor& actor : state_->actors) {
        if (actor.candidates) {
            for (Candidate& candidate : *actor.candidates) {
                state_->judge(actor, candidate);
            }
        }
    }
    if (end == End::Closed) {
        state_->leakedDescriptors();
    }
}

const std::vector<Finding>& Ledger::findings() const {
    return state_->findings;
}
std::uint64_t Ledger::findingsDropped() const {
    return state_->dropped;
}
std::uint64_t Ledger::eventsSeen() const {
    return state_->events;
}
std::size_t Ledger::memoryBytes() const {
    return state_->bytes();
}

std::vector<Unheard> Ledger::unheard() const {
    std::vector<Unheard> all;
    for (const Actor& actor : state_->actors) {
        if (actor.lost) {
            all.push_back({actor.id, actor.lost_since,
                           fmt::format("{}; {} events were kept back for it, further ones were not judged",
                                       actor.lost_at, state_->options.max_held)});
        } else if (actor.untold) {
            all.push_back({actor.id, actor.told == 0 ? 0 : actor.frame + 1,
                           actor.name + (actor.told == 0 ? ": told nothing" : ": told nothing more")});
        } else if (actor.told == 0 && !actor.isThread() && actor.kind != ActorKind::Process) {
            all.push_back({actor.id, 0, actor.name + ": is declared and does nothing here"});
        }
    }
    return all;
}

std::vector<Blocked> Ledger::blocked() const {
    std::vector<Blocked> all;
    for (const Actor& actor : state_->actors) {
        const Item* item = state_->standsAt(actor);
        if (item != nullptr && !item->join) {
            all.push_back({actor.id, item->event.object, item->event.value, item->event.time_ns});
        }
    }
    return all;
}

std::vector<std::string> Ledger::waitChain(ActorId actor) const {
    const Slot slot = state_->actor_slots.find(actor);
    return slot == kNoSlot ? std::vector<std::string>{} : state_->chainLines(state_->actors[slot]);
}

std::string Ledger::actorName(ActorId id) const {
    return state_->name(id);
}

std::string Ledger::syncName(ObjectId id) const {
    const Slot slot = state_->sync_slots.find(id);
    return slot == kNoSlot ? "sync " + std::to_string(id) : state_->syncs[slot].name;
}

std::string Ledger::resourceName(ObjectId id) const {
    const Slot slot = state_->resource_slots.find(id);
    return slot == kNoSlot ? "resource " + std::to_string(id) : state_->resources[slot].name;
}

}  // namespace sluice::ledger
