// SPDX-License-Identifier: MIT
// The ledger while the program runs: any thread may write to it, and what it is told can go to a log as well.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sluice/ledger/ledger.hpp"
#include "sluice/ledger/log.hpp"
#include "sluice/result.hpp"

namespace sluice::ledger {

/// From this frame on the ledger was not told enough to judge; 1: from the first.
struct Unchecked {
    std::uint64_t since_frame = 1;
    std::string why;
};

/// Of the renderers that one host has one after the other: which this is, and the frames that went before it.
struct RendererLife {
    std::uint32_t number = 1;
    std::uint64_t frames_before = 0;

    /// `actor` of this renderer's time: as it is for the first, "actor, 2nd renderer" for the second.
    [[nodiscard]] std::string nameOf(std::string_view actor) const;
};

/// A Ledger behind a mutex. The log, if there is one, has every record in the order in which the ledger got it.
class LiveLedger {
  public:
    explicit LiveLedger(LedgerOptions options = {}, std::unique_ptr<LogWriter> log = nullptr);
    LiveLedger(const LiveLedger&) = delete;
    LiveLedger& operator=(const LiveLedger&) = delete;
    /// Ends the log, if finish() has not.
    ~LiveLedger() = default;

    // As those of Ledger. An actor that lives and is declared again as what it is stays the same actor.
    void declareActor(ActorId id, ActorKind kind, std::string_view name);
    void declareSync(ObjectId id, SyncKind kind, std::string_view name, std::uint64_t initial, std::uint16_t flags);
    void declareResource(ObjectId id, std::string_view name, std::uint32_t layout, ActorId owner);
    void record(const Event& event);
    /// An Export or Import, with what it says of the memory.
    void recordMemory(const Event& event, const MemoryFacts& facts);
    [[nodiscard]] std::vector<std::string> waitChain(ActorId actor) const;

    /// A renderer is about to be made: the feeds that are made from now on speak of it, and number its frames on.
    void rendererBegins(RendererLife life);
    [[nodiscard]] RendererLife rendererLife() const;

    /// Whoever tells this ledger knows that it is not told everything. The first word stays.
    void leaveUnchecked(Unchecked what);
    /// Empty: findings() speaks for everything that was recorded.
    [[nodiscard]] std::optional<Unchecked> unchecked() const;

    /// Judges what is still open and ends the log: the first failure to write it. What comes later is not recorded, so
    /// that a thread that is late does no harm.
    Status finish(End end);

    [[nodiscard]] std::vector<Finding> findings() const;
    [[nodiscard]] std::uint64_t findingsDropped() const;
    [[nodiscard]] std::uint64_t eventsSeen() const;
    [[nodiscard]] std::size_t memoryBytes() const;

  private:
    mutable std::mutex mutex_;
    Ledger ledger_;                                                // guarded by mutex_
    std::unique_ptr<LogWriter> log_;                               // guarded by mutex_
    bool finished_ = false;                                        // guarded by mutex_
    std::map<ActorId, std::pair<ActorKind, std::string>> living_;  // guarded by mutex_
    std::optional<Unchecked> unchecked_;                           // guarded by mutex_
    RendererLife life_;                                            // guarded by mutex_
};

}  // namespace sluice::ledger
