// SPDX-License-Identifier: MIT
// Accesses: who touches a resource, ordered after whom, and what the pixels say to it.
#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

ReadMark& markOf(Resource& resource, const Actor& by) {
    const auto found = std::find_if(resource.reads.begin(), resource.reads.end(),
                                    [&](const ReadMark& mark) { return mark.at.actor == by.slot; });
    return found == resource.reads.end() ? resource.reads.emplace_back() : *found;
}

}  // namespace

void Ledger::State::access(Actor& by, const Item& item) {
    Resource& resource = resources[item.slot];
    const Event& event = item.event;
    if (resource.destroyed) {
        if (auto* found = report(FindingKind::UseAfterDestroy, resource.id, *resource.destroyed, event)) {
            found->sentence =
                fmt::format("{} {} {} in frame {}, which {} has destroyed in frame {}.", by.name, verb(event.kind),
                            resource.name, event.frame, name(resource.destroyed->actor), resource.destroyed->frame);
            found->remedy = fmt::format("Let {} wait for the last use by {} before it destroys {}.",
                                        name(resource.destroyed->actor), by.name, resource.name);
        }
        return;
    }
    if (resource.behind && by.slot == resource.behind->actor && by.after(resource.behind->until)) {
        resource.behind.reset();
    }
    const bool writes = event.kind != EventKind::Read;
    bool broken = againstWrite(by, resource, item.slot, event);
    if (writes) {
        broken |= againstReads(by, resource, event);
    }
    bool stale = false;
    if (!broken) {
        checkOwner(by, resource, event);
        stale = event.kind == EventKind::Read && event.value != 0 && resource.content && resource.content->value != 0 &&
                resource.content->value != event.value;
    }
    if (stale) {
        if (auto* found = report(FindingKind::StaleRead, resource.id, *resource.content, event)) {
            found->edge = fmt::format("{}:write({}, {}) -> {}:read({}, {})", name(resource.content->actor),
                                      resource.name, event.value, by.name, resource.name, event.value);
            found->sentence = fmt::format(
                "{} expects version {} of {} in frame {}, but is ordered after the write of version {} by "
                "{} and no other.",
                by.name, event.value, resource.name, event.frame, resource.content->value,
                name(resource.content->actor));
            found->remedy = fmt::format("Let {} wait for the signal that follows the write of version {} of {}.",
                                        by.name, event.value, resource.name);
        }
    }
    if (event.kind == EventKind::Read) {
        ReadMark& mark = markOf(resource, by);
        settleWitness(resource, mark);
        mark = ReadMark{by.now(), event, true, broken || stale, broken, resource.raced_input, std::nullopt};
        if (stale || resource.raced_input) {
            by.raced_in = event.frame;
        }
    } else if (resource.behind && by.slot == resource.behind->actor) {
        resource.behind->last = by.now();
        resource.behind->last_event = event;
    } else {
        resource.write_at = by.now();
        resource.write_event = event;
        if (event.kind == EventKind::Write) {
            resource.content = event;
            resource.raced_input = by.raced_in == event.frame;
        }
    }
    if (event.kind == EventKind::Release) {
        releasedLate(by, resource, event);
    }
}

bool Ledger::State::againstWrite(Actor& by, Resource& resource, Slot slot, const Event& event) {
    const Epoch at = resource.write_at;
    if (at.tick == 0 || at.actor == by.slot) {
        return false;
    }
    const Event before = resource.write_event;
    if (!by.after(at)) {
        race(event.kind == EventKind::Read ? FindingKind::ReadAfterWrite : FindingKind::WriteAfterWrite, by, resource,
             at, before, event);
        return true;
    }
    needed(by, at);
    if (by.know.sees(at, slot)) {
        return false;
    }
    if (auto* found = report(FindingKind::NotListed, resource.id, before, event)) {
        found->edge = missingEdge(at, before, by, event, resource.name).edge;
        found->sentence = fmt::format(
            "{} {} {} in frame {}, ordered after the {} by {}, but the semaphore's lists leave {} out.", by.name,
            verb(event.kind), resource.name, event.frame, accessText(before), name(before.actor), resource.name);
        found->remedy = fmt::format("Name {} in the signal's list and in the wait's list.", resource.name);
    }
    Clock told;
    told.raise(at);
    by.know.see(slot, told);
    return true;
}

bool Ledger::State::againstReads(Actor& by, Resource& resource, const Event& event) {
    bool broken = false;
    for (ReadMark& mark : resource.reads) {
        if (!mark.active) {
            continue;
        }
        mark.active = false;
        if (mark.at.actor != by.slot && !by.after(mark.at)) {
            broken = true;
            mark.broken = mark.lucky = true;
            race(FindingKind::WriteAfterRead, by, resource, mark.at, mark.event, event);
        } else if (mark.at.actor != by.slot) {
            needed(by, mark.at);
        }
        settleWitness(resource, mark);
    }
    return broken;
}

void Ledger::State::witness(Actor& by, const Item& item) {
    Resource& resource = resources[item.slot];
    ReadMark& mark = markOf(resource, by);
    if (mark.at.tick == 0) {  // pixels of a read that was not logged: judged as if it stood here
        mark.at = by.now();
        mark.event = item.event;
        mark.active = true;
        mark.broken = mark.lucky = resource.write_at.tick != 0 && !by.after(resource.write_at);
    }
    mark.witness = item.event;
    if (mark.broken || !mark.active) {
        settleWitness(resource, mark);
    }
}

void Ledger::State::settleWitness(Resource& resource, ReadMark& mark) {
    if (!mark.witness) {
        return;
    }
    const Event event = *mark.witness;
    mark.witness.reset();
    const auto verdict = static_cast<Verdict>(event.aux);
    if (verdict == Verdict::Fresh && mark.lucky) {
        if (auto* found = report(FindingKind::LuckyRace, resource.id, mark.event, event)) {
            found->sentence = fmt::format(
                "The pixels of {} were right for {} in frame {}, by luck: its read is in a "
                "race.",
                resource.name, name(event.actor), event.frame);
            found->remedy = fmt::format("Mend the race on {} all the same.", resource.name);
        }
    } else if (verdict != Verdict::Fresh && !mark.broken && !mark.raced_input) {
        if (auto* found = report(FindingKind::DriverReordered, resource.id, mark.event, event)) {
            found->sentence = fmt::format(
                "{} reads {} in frame {} in good order, yet the pixels are {} (version {} found, {} "
                "expected).",
                name(event.actor), resource.name, event.frame, toString(verdict), event.value, mark.event.value);
            found->remedy = fmt::format(
                "Suspect the driver, or an access to {} that was not logged; try another "
                "backend.",
                resource.name);
        }
    }
}

}  // namespace sluice::ledger
