// SPDX-License-Identifier: MIT
#include <random>
#include <stdexcept>
#include <utility>

#include "random_program.hpp"

namespace sluice::ledger::test {

std::string mutate(Program& program, Choices& choices) {
    std::vector<std::pair<std::size_t, std::size_t>> places;
    for (std::size_t actor = 0; actor < program.ops.size(); ++actor) {
        for (std::size_t i = 0; i < program.ops[actor].size(); ++i) {
            const EventKind kind = program.ops[actor][i].event.kind;
            if (kind == EventKind::Signal || kind == EventKind::Wait || kind == EventKind::Names ||
                kind == EventKind::Submit) {
                places.emplace_back(actor, i);
            }
        }
    }
    if (places.empty()) {
        return "nothing to break";
    }
    const auto at = (choices.below(256) * 256 + choices.below(256)) % places.size();
    const auto [actor, index] = places[at];
    auto& ops = program.ops[actor];
    const auto place = ops.begin() + static_cast<std::ptrdiff_t>(index);
    Event& event = place->event;
    const std::string what = std::string(toString(event.kind)) + " " + std::to_string(event.object) + " of actor " +
                             std::to_string(actor) + " at " + std::to_string(index);
    const bool timeline = (event.kind == EventKind::Signal || event.kind == EventKind::Wait) &&
                          program.syncs[event.object].kind == SyncKind::Timeline;
    const auto how = choices.below(4);
    if (how == 1 && timeline) {
        event.value += 1 + choices.below(2);
        return "raised the value of " + what;
    }
    if (how == 2 && timeline && event.value > 1) {
        --event.value;
        return "lowered the value of " + what;
    }
    if (how == 3 && index + 1 < ops.size() && event.kind != EventKind::Submit &&
        ops[index + 1].event.kind != EventKind::Submit) {
        std::swap(event, ops[index + 1].event);
        return "swapped with the next: " + what;
    }
    if (how == 2 && timeline && event.kind == EventKind::Signal) {
        ops.insert(place, *place);
        return "duplicated " + what;
    }
    ops.erase(place);
    return "dropped " + what;
}

std::vector<Event> interleave(const Program& program, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<std::size_t> next(program.ops.size(), 0);
    // Submissions that still have to be logged, by stream.
    std::map<std::size_t, std::set<std::uint32_t>> open;
    std::size_t left = 0;
    for (const auto& ops : program.ops) {
        left += ops.size();
        for (const Op& op : ops) {
            if (op.event.kind == EventKind::Submit) {
                open[op.event.object].insert(op.batch);
            }
        }
    }
    const auto possible = [&](std::size_t actor) {
        const Op& op = program.ops[actor][next[actor]];
        if (op.event.kind != EventKind::Submit) {
            const auto& mine = open[actor];
            return mine.empty() || *mine.begin() > op.batch;
        }
        const std::size_t stream = op.event.object;
        const bool given =
            next[stream] == program.ops[stream].size() || program.ops[stream][next[stream]].batch >= op.batch;
        return given && *open[stream].begin() == op.batch;
    };
    std::vector<Event> log;
    while (log.size() < left) {
        std::size_t actor = random() % next.size();
        std::size_t tried = 0;
        while (tried < next.size() && (next[actor] == program.ops[actor].size() || !possible(actor))) {
            actor = (actor + 1) % next.size();
            ++tried;
        }
        if (tried == next.size()) {
            throw std::logic_error("the program has no log");
        }
        // Long runs of one actor as well as quick changes: waits far ahead of their signals.
        for (std::size_t run = 1 + random() % 8; run > 0 && next[actor] < program.ops[actor].size() && possible(actor);
             --run) {
            const Op& op = program.ops[actor][next[actor]++];
            if (op.event.kind == EventKind::Submit) {
                open[op.event.object].erase(op.batch);
            }
            log.push_back(op.event);
            log.back().sequence = log.size() - 1;
        }
    }
    return log;
}

Ledger replay(const Program& program, const std::vector<Event>& log, std::size_t prune_above) {
    LedgerOptions options;
    options.performance = false;
    options.prune_above = prune_above;
    Ledger ledger(options);
    for (std::size_t i = 0; i < program.actors.size(); ++i) {
        ledger.declareActor(static_cast<ActorId>(i), program.actors[i], "actor" + std::to_string(i));
    }
    for (std::size_t i = 0; i < program.syncs.size(); ++i) {
        ledger.declareSync(static_cast<ObjectId>(i), program.syncs[i].kind, "sync" + std::to_string(i), 0,
                           program.syncs[i].listed ? kListedOnly : 0);
    }
    for (ObjectId i = 0; i < kResources; ++i) {
        ledger.declareResource(i, "resource" + std::to_string(i), 0, kNoActor);
    }
    for (const Event& event : log) {
        ledger.record(event);
    }
    return ledger;
}

std::string describe(const Program& program) {
    std::string text;
    for (std::size_t actor = 0; actor < program.ops.size(); ++actor) {
        text += std::string(toString(program.actors[actor])) + " " + std::to_string(actor) + ":";
        for (const Op& op : program.ops[actor]) {
            text += " " + std::string(toString(op.event.kind)) + "(" + std::to_string(op.event.object) + "," +
                    std::to_string(op.event.value) + ")@" + std::to_string(op.batch);
        }
        text += '\n';
    }
    return text;
}

}  // namespace sluice::ledger::test
