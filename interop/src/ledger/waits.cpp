// SPDX-License-Identifier: MIT
// Who waits for whom, while the program runs and at its end.
#include <algorithm>

#include <fmt/format.h>

#include "state.hpp"

namespace sluice::ledger {
namespace {

bool givesWhat(const Item& item, const Item& wait, const Sync& sync) {
    return item.event.kind == EventKind::Signal && item.slot == wait.slot &&
           (sync.kind != SyncKind::Timeline || item.event.value >= wait.event.value);
}

}  // namespace

bool Ledger::State::satisfied(const Item& wait) const {
    const Sync& sync = syncs[wait.slot];
    return sync.kind == SyncKind::Timeline ? wait.event.value <= sync.current : !sync.entries.empty();
}

const Item* Ledger::State::standsAt(const Actor& who) const {
    if (!who.queue.empty()) {
        return &who.queue.front();
    }
    return who.open_wait && !satisfied(*who.open_wait) ? &*who.open_wait : nullptr;
}

const Actor* Ledger::State::wouldSatisfy(const Actor& who, const Item& wait) const {
    if (wait.join) {
        return &actors[wait.ticket->submitter];
    }
    const Sync& sync = syncs[wait.slot];
    const auto gives = [&](const Actor& actor) {
        return std::any_of(actor.queue.begin(), actor.queue.end(),
                           [&](const Item& item) { return givesWhat(item, wait, sync); });
    };
    // Another one's signal first: one's own behind the wait is a circle only when nobody else has one.
    for (const Actor& actor : actors) {
        if (&actor != &who && gives(actor)) {
            return &actor;
        }
    }
    return gives(who) ? &who : nullptr;
}

std::vector<Ledger::State::Link> Ledger::State::follow(const Actor& who, bool& cycle) const {
    std::vector<Link> links;
    const Actor* next = &who;
    cycle = false;
    while (next != nullptr) {
        const Item* wait = standsAt(*next);
        if (wait == nullptr) {
            break;
        }
        cycle = std::any_of(links.begin(), links.end(), [&](const Link& link) { return link.actor == next; });
        links.push_back({next, wait});
        if (cycle) {
            break;
        }
        next = wouldSatisfy(*next, *wait);
    }
    return links;
}

std::vector<std::string> Ledger::State::chainLines(const Actor& who) const {
    bool cycle = false;
    const auto links = follow(who, cycle);
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < links.size(); ++i) {
        const auto& [actor, wait] = links[i];
        if (cycle && i + 1 == links.size()) {
            lines.push_back(fmt::format("{} again: the circle is closed", actor->name));
            break;
        }
        if (wait->join) {
            lines.push_back(fmt::format("{} waits for submission {} of {}, which comes after:", actor->name,
                                        wait->event.value, actors[wait->ticket->submitter].name));
            continue;
        }
        const Sync& sync = syncs[wait->slot];
        std::string line = fmt::format("{} waits for {}, which {}; ", actor->name, syncText(sync, wait->event.value),
                                       sync.kind == SyncKind::Timeline ? fmt::format("has reached {}", sync.current)
                                       : sync.consumed ? fmt::format("the wait of {} took", name(sync.consumed->actor))
                                                       : std::string("is not signalled"));
        if (i + 1 < links.size()) {
            lines.push_back(line +
                            fmt::format("{} would signal it, but stands behind a wait:", links[i + 1].actor->name));
            continue;
        }
        const auto last =
            std::find_if(sync.uses.begin(), sync.uses.end(), [](const SyncUse& use) { return use.signalled; });
        if (last == sync.uses.end()) {
            line += "nobody has ever signalled it";
        } else {
            const Actor& signaller = actors[last->at.actor];
            line += fmt::format("{}, who signalled it before, {}", signaller.name,
                                signaller.ended ? "has ended" : "has not signalled that yet");
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

bool Ledger::State::somebodyLeft(const Actor& who, const Sync& sync) const {
    bool known_signaller = false;
    for (const SyncUse& use : sync.uses) {
        known_signaller |= use.signalled;
        if (use.signalled && use.at.actor != who.slot && !actors[use.at.actor].ended) {
            return true;
        }
    }
    return !known_signaller && std::any_of(actors.begin(), actors.end(),
                                           [&](const Actor& other) { return &other != &who && !other.ended; });
}

bool Ledger::State::untold(const Sync& sync) const {
    const auto signalled = [](const SyncUse& use) { return use.signalled; };
    if (std::none_of(sync.uses.begin(), sync.uses.end(), signalled)) {
        return std::any_of(actors.begin(), actors.end(), [](const Actor& actor) { return actor.untold; });
    }
    return std::any_of(sync.uses.begin(), sync.uses.end(),
                       [&](const SyncUse& use) { return use.signalled && actors[use.at.actor].untold; });
}

void Ledger::State::judgeWaits(End end) {
    for (const Actor& who : actors) {
        const Item* wait = standsAt(who);
        if (wait == nullptr || wait->join || syncs[wait->slot].blamed || untold(syncs[wait->slot])) {
            continue;
        }
        bool cycle = false;
        const auto links = follow(who, cycle);
        const Sync& sync = syncs[wait->slot];
        const Event& event = wait->event;
        if (cycle) {
            // Told once, by the member with the lowest slot; those who only wait for the circle are its victims.
            const auto lowest = std::min_element(links.begin(), links.end(), [](const Link& a, const Link& b) {
                return std::pair(a.wait->join, a.actor->slot) < std::pair(b.wait->join, b.actor->slot);
            });
            if (links.back().actor != &who || lowest->actor != &who) {
                continue;
            }
            const Link& next = links[1];
            if (auto* found = report(FindingKind::WaitCycle, sync.id, next.wait->event, event)) {
                found->chain = chainLines(who);
                found->edge = fmt::format("{}:signal({}, {}) behind its wait -> {}:wait", next.actor->name, sync.name,
                                          event.value, who.name);
                found->sentence = fmt::format(
                    "{} waits for {} in frame {}, which can only come after {}'s own wait: "
                    "a circle of {}.",
                    who.name, syncText(sync, event.value), event.frame, next.actor->name, links.size() - 1);
                found->remedy = fmt::format("Let {} signal {} before it waits, or let {} wait for an earlier value.",
                                            next.actor->name, sync.name, who.name);
            }
            continue;
        }
        if (links.size() != 1) {
            continue;  // whoever stands at the end of the chain is the cause
        }
        const bool open = end == End::Truncated && somebodyLeft(who, sync);
        const bool twice = !open && sync.kind == SyncKind::Binary && sync.consumed;
        const FindingKind kind = open    ? FindingKind::WaitNotSubmitted
                                 : twice ? FindingKind::BinaryWaitedTwice
                                         : FindingKind::WaitUnsatisfiable;
        if (auto* found = report(kind, sync.id, twice ? *sync.consumed : event, event)) {
            found->chain = chainLines(who);
            found->edge = fmt::format("?:signal({0}, {1}) -> {2}:wait({0}, {1})", sync.name, event.value, who.name);
            const std::string wanted = syncText(sync, event.value);
            found->sentence =
                open ? fmt::format("{} waits for {} in frame {}, and the log ends before anybody signals it.", who.name,
                                   wanted, event.frame)
                : twice ? fmt::format(
                              "{} waits for {} in frame {}, but the wait of {} in frame {} took its signal, "
                              "and no other came.",
                              who.name, wanted, event.frame, name(sync.consumed->actor), sync.consumed->frame)
                        : fmt::format("{} waits for {} in frame {}, and nobody is left to signal it.", who.name, wanted,
                                      event.frame);
            found->remedy =
                open ? fmt::format(
                           "The log was cut here, so nothing need be wrong: record on until it is closed. If the "
                           "wait is there again, submit the signal of {}.",
                           wanted)
                     : fmt::format("Signal {} once for this wait, or drop the wait of {}.", wanted, who.name);
        }
    }
}

}  // namespace sluice::ledger
