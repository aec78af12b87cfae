// SPDX-License-Identifier: MIT
// What was really done, told to the ordering ledger, and kept since the last check so that a failure leaves a log.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "sluice/ledger/ledger.hpp"
#include "sluice/result.hpp"
#include "stress/slots.hpp"

namespace sluice::stress {

// Actors of the ledger.
inline constexpr ledger::ActorId kGl = 0, kQueue = 1, kHost = 2, kBridge = 3, kRelayOut = 4, kRelayBack = 5;
// Its timelines. The last two exist only where a relay stands between the two sides.
inline constexpr ledger::ObjectId kToRenderer = 0, kToHost = 1, kFromGl = 2, kToGl = 3;

/// Any thread may write.
class Book {
  public:
    Book();

    /// New resources and timelines, which begin at 0, under the old numbers.
    void declare(const Storage& storage);
    void event(ledger::EventKind kind, ledger::ActorId by, ledger::ObjectId object, std::uint64_t value = 0,
               std::uint16_t aux = 0, std::uint16_t flags = 0, std::uint64_t duration_ns = 0);
    /// `by` gives work to `stream`, whose events follow.
    void submit(ledger::ActorId by, ledger::ActorId stream) { event(ledger::EventKind::Submit, by, stream); }
    /// OpenGL's stream gives the fence after which host-to-renderer value `value` will be signalled.
    void fence(std::uint64_t value);
    /// `by` has seen that fence arrive.
    void fenceArrived(ledger::ActorId by, std::uint64_t value);

    /// Both sides stand still: what a log has to begin with.
    void checkpoint();
    /// No event follows.
    void finish();

    /// How often something was found that is more than a waste of time.
    [[nodiscard]] std::uint64_t troubles() const;
    /// "race-read-after-write (3): sentence", one line per finding of that kind.
    [[nodiscard]] std::vector<std::string> told() const;
    /// Who waits for whom, from `actor` on.
    [[nodiscard]] std::vector<std::string> waitChain(ledger::ActorId actor) const;
    /// Writes the events since the last checkpoint, for `sluice diagnose`.
    [[nodiscard]] Status writeLog(const std::string& path) const;

  private:
    static constexpr ledger::ObjectId kFirstFence = 8;
    static constexpr std::uint32_t kFences = 64;  ///< far more than rounds in flight

    struct Line {
        ledger::Event event;
        bool declares_fence = false;  ///< event.object is a new fence, and the event itself is none
    };
    void add(const ledger::Event& event);

    mutable std::mutex mutex_;
    ledger::Ledger ledger_;
    Storage storage_;
    std::vector<Line> lines_;
    std::array<std::uint64_t, 4> reached_{}, at_checkpoint_{};  // of each timeline
    std::array<std::uint64_t, kFences> fence_of_{};             // value that each fence stands for
    std::uint32_t next_fence_ = 0;
};

}  // namespace sluice::stress
