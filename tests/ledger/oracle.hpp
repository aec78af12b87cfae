// SPDX-License-Identifier: MIT
// A second opinion: programs as explicit graphs, reachability by brute force, no vector clocks. Slow and plain.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "sluice/ledger/event.hpp"

namespace sluice::ledger::test {

inline constexpr std::size_t kMaxNodes = 2048;
inline constexpr std::uint32_t kResources = 4;
using Bits = std::bitset<kMaxNodes>;

struct Op {
    Event event;
    std::uint32_t batch = 0;  ///< a stream's event: the number of the Submit that it was given with; a Submit: its own
};

struct SyncDecl {
    SyncKind kind;
    bool listed = false;
};

struct Program {
    std::vector<ActorKind> actors;
    std::vector<SyncDecl> syncs;
    std::vector<std::vector<Op>> ops;  ///< by actor
};

/// Runs events one at a time and keeps the closure of what came before each.
class Execution {
  public:
    explicit Execution(const Program& program);
    /// False when `op`, the next of `actor`, cannot happen yet.
    bool run(ActorId actor, const Op& op);
    /// Whether the node happened before whatever `actor` does next.
    [[nodiscard]] bool before(int node, ActorId actor) const;
    [[nodiscard]] bool visible(int node, ActorId actor, ObjectId resource) const;

    struct Access {
        int node;
        ActorId actor;
        Event event;
    };
    std::vector<std::vector<Access>> accesses;  ///< by resource, in the order of this run
    [[nodiscard]] const Bits& past(int node) const { return nodes_.at(static_cast<std::size_t>(node)).before; }
    [[nodiscard]] bool sees(const Access& later, const Access& earlier, ObjectId resource) const;
    [[nodiscard]] int last(ActorId actor) const { return last_.at(actor); }

  private:
    struct Node {
        Bits before;
        std::vector<Bits> seen;  ///< by resource
    };
    struct Given {
        int node;
        std::uint64_t value;
        std::uint32_t mask;
    };
    struct Edge {
        int from;
        std::uint32_t mask;
    };
    bool waitEdges(const Op& op, std::uint32_t mask, std::vector<Edge>& edges);

    const Program& program_;
    std::vector<Node> nodes_;
    std::vector<int> last_;
    std::vector<std::uint32_t> names_;
    std::vector<bool> named_;
    std::map<ObjectId, std::vector<Given>> given_;
    std::map<ActorId, std::map<std::uint32_t, int>> submits_;  ///< by stream and number; -1: not run yet
};

struct OracleVerdict {
    std::set<ObjectId> racing;
    std::set<ObjectId> unlisted;  ///< ordered, but an access does not see the write before it; not told of racing ones
    std::size_t stuck = 0;        ///< events that never happen
};
[[nodiscard]] OracleVerdict judge(const Program& program);

[[nodiscard]] bool isAccess(EventKind kind);

}  // namespace sluice::ledger::test
