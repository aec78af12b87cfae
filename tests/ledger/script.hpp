// SPDX-License-Identifier: MIT
// Short programs for the ledger: a small cast with fixed names, and a verb for each event.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sluice/ledger/ledger.hpp"

namespace sluice::ledger::test {

inline constexpr ActorId kGl = 0, kQueue = 1, kEngine = 2, kBridge = 3, kQueue2 = 4;
inline constexpr ObjectId kHost = 0, kDone = 1, kBinary = 2, kFence = 3, kListed = 4;
inline constexpr ObjectId kColour = 0, kDepth = 1;
inline constexpr std::uint64_t kMs = 1'000'000;

/// The cast is declared, the verbs record at once. Each event takes a microsecond of the script's own clock.
class Script {
  public:
    explicit Script(LedgerOptions options = {});

    void signal(ActorId by, ObjectId sync, std::uint64_t value, std::uint16_t flags = 0);
    void wait(ActorId by, ObjectId sync, std::uint64_t value, std::uint64_t duration_ns = 0, std::uint16_t flags = 0);
    void waitBegin(ActorId by, ObjectId sync, std::uint64_t value);
    void submit(ActorId by, ActorId stream);
    void read(ActorId by, ObjectId resource, std::uint64_t version = 0);
    void write(ActorId by, ObjectId resource, std::uint64_t version = 0);
    void release(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to, ActorId other = kNoActor);
    void acquire(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to, ActorId other = kNoActor);
    void layout(ActorId by, ObjectId resource, std::uint32_t from, std::uint32_t to);
    void names(ActorId by, ObjectId resource, std::uint32_t layout = 0);
    void destroy(ActorId by, ObjectClass what, ObjectId object);
    void event(EventKind kind, ActorId by, ObjectId object = kNoObject, std::uint64_t value = 0, std::uint16_t aux = 0,
               std::uint16_t flags = 0, std::uint64_t duration_ns = 0);
    void witness(ActorId by, ObjectId resource, std::uint64_t version, Verdict verdict);

    Ledger ledger;

  private:
    std::uint64_t now_ = 0;
    std::uint64_t sequence_ = 0;
};

[[nodiscard]] std::vector<FindingKind> kinds(const Ledger& ledger);
/// The findings' ids and sentences, for a failure's message.
[[nodiscard]] std::string tell(const Ledger& ledger);

}  // namespace sluice::ledger::test
