// SPDX-License-Identifier: MIT
#include "oracle.hpp"

#include <algorithm>
#include <stdexcept>

namespace sluice::ledger::test {
namespace {

constexpr std::uint32_t kAll = 0xFFFFFFFF;

}  // namespace

bool isAccess(EventKind kind) {
    return kind == EventKind::Read || kind == EventKind::Write || kind == EventKind::Layout ||
           kind == EventKind::Release || kind == EventKind::Acquire;
}

Execution::Execution(const Program& program)
    : accesses(kResources),
      program_(program),
      last_(program.actors.size(), -1),
      names_(program.actors.size(), 0),
      named_(program.actors.size(), false) {
    for (const auto& ops : program.ops) {
        for (const Op& op : ops) {
            if (op.event.kind == EventKind::Submit) {
                submits_[static_cast<ActorId>(op.event.object)][op.batch] = -1;
            }
        }
    }
}

bool Execution::waitEdges(const Op& op, std::uint32_t mask, std::vector<Edge>& edges) {
    auto& given = given_[op.event.object];
    const SyncDecl& sync = program_.syncs.at(op.event.object);
    if (sync.kind != SyncKind::Timeline) {
        if (given.empty()) {
            return false;
        }
        edges.push_back({given.front().node, given.front().mask & mask});
        if (sync.kind == SyncKind::Binary) {
            given.clear();
        }
        return true;
    }
    if (op.event.value == 0) {
        return true;
    }
    const auto enough =
        std::find_if(given.begin(), given.end(), [&](const Given& signal) { return signal.value >= op.event.value; });
    if (enough == given.end()) {
        return false;
    }
    for (auto signal = given.begin(); signal <= enough; ++signal) {
        edges.push_back({signal->node, signal->mask & mask});
    }
    return true;
}

bool Execution::run(ActorId actor, const Op& op) {
    const Event& event = op.event;
    std::vector<Edge> edges;
    if (last_[actor] >= 0) {
        edges.push_back({last_[actor], kAll});
    }
    if (event.kind == EventKind::Submit) {
        submits_[static_cast<ActorId>(event.object)][op.batch] = -1;
    } else if (const auto given = submits_.find(actor); given != submits_.end()) {
        for (const auto& [number, node] : given->second) {
            if (number > op.batch) {
                break;
            }
            if (node < 0) {
                return false;
            }
            edges.push_back({node, kAll});
        }
    }
    const bool order = event.kind == EventKind::Signal || event.kind == EventKind::Wait;
    std::uint32_t mask = kAll;
    if (order && program_.syncs.at(event.object).listed &&
        (named_[actor] || program_.actors[actor] == ActorKind::GlContext)) {
        mask = names_[actor];
    }
    if (event.kind == EventKind::Wait && !waitEdges(op, mask, edges)) {
        return false;
    }
    const int node = static_cast<int>(nodes_.size());
    if (nodes_.size() >= kMaxNodes) {
        throw std::length_error("program too long for the oracle");
    }
    Node fresh{{}, std::vector<Bits>(kResources)};
    for (const Edge& edge : edges) {
        const auto from = static_cast<std::size_t>(edge.from);
        fresh.before |= nodes_[from].before;
        fresh.before.set(from);
        for (std::uint32_t r = 0; r < kResources; ++r) {
            if ((edge.mask >> r & 1U) != 0) {
                fresh.seen[r] |= nodes_[from].seen[r];
                fresh.seen[r].set(from);
            }
        }
    }
    nodes_.push_back(std::move(fresh));
    last_[actor] = node;
    if (event.kind == EventKind::Names) {
        names_[actor] |= 1U << event.object;
        named_[actor] = true;
    } else if (order) {
        names_[actor] = 0;
        named_[actor] = false;
    }
    if (event.kind == EventKind::Submit) {
        submits_[static_cast<ActorId>(event.object)][op.batch] = node;
    } else if (event.kind == EventKind::Signal) {
        auto& given = given_[event.object];
        const bool timeline = program_.syncs[event.object].kind == SyncKind::Timeline;
        if (timeline ? event.value > (given.empty() ? 0 : given.back().value) : given.empty()) {
            given.push_back({node, event.value, mask});
        }
    } else if (isAccess(event.kind)) {
        accesses[event.object].push_back({node, actor, event});
    }
    return true;
}

bool Execution::before(int node, ActorId actor) const {
    const int last = last_[actor];
    return last >= 0 && (last == node || past(last).test(static_cast<std::size_t>(node)));
}

bool Execution::visible(int node, ActorId actor, ObjectId resource) const {
    const int last = last_[actor];
    return last >= 0 &&
           (last == node || nodes_[static_cast<std::size_t>(last)].seen[resource].test(static_cast<std::size_t>(node)));
}

bool Execution::sees(const Access& later, const Access& earlier, ObjectId resource) const {
    return nodes_[static_cast<std::size_t>(later.node)].seen[resource].test(static_cast<std::size_t>(earlier.node));
}

OracleVerdict judge(const Program& program) {
    Execution execution(program);
    std::vector<std::size_t> next(program.ops.size(), 0);
    for (bool moved = true; moved;) {
        moved = false;
        for (std::size_t actor = 0; actor < next.size(); ++actor) {
            while (next[actor] < program.ops[actor].size() &&
                   execution.run(static_cast<ActorId>(actor), program.ops[actor][next[actor]])) {
                ++next[actor];
                moved = true;
            }
        }
    }
    OracleVerdict verdict;
    for (std::size_t actor = 0; actor < next.size(); ++actor) {
        verdict.stuck += program.ops[actor].size() - next[actor];
    }
    for (ObjectId r = 0; r < kResources; ++r) {
        const auto& all = execution.accesses[r];
        bool unseen = false;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Execution::Access* write = nullptr;
            for (std::size_t j = 0; j < i; ++j) {
                const bool conflict = all[i].event.kind != EventKind::Read || all[j].event.kind != EventKind::Read;
                if (conflict && all[i].actor != all[j].actor &&
                    !execution.past(all[i].node).test(static_cast<std::size_t>(all[j].node))) {
                    verdict.racing.insert(r);
                }
                write = all[j].event.kind != EventKind::Read ? &all[j] : write;
            }
            unseen |= write != nullptr && write->actor != all[i].actor && !execution.sees(all[i], *write, r);
        }
        if (unseen && verdict.racing.count(r) == 0) {
            verdict.unlisted.insert(r);
        }
    }
    return verdict;
}

}  // namespace sluice::ledger::test
