// SPDX-License-Identifier: MIT
// One combination under way: what run.cpp (epochs, checks, verdicts) and turns.cpp (hand-offs) share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "stress/book.hpp"
#include "stress/loss.hpp"
#include "stress/plan.hpp"
#include "stress/rig.hpp"
#include "stress/round.hpp"
#include "stress/run.hpp"

namespace sluice::stress {

/// Pinned: its parts refer to each other.
class Runner {
  public:
    Runner(const Combination& combination, std::uint64_t seed)
        : planner_(combination, seed),
          course_(combination.pattern, planner_.shape(), seedOf(combination, seed)),
          rig_(combination, planner_.shape(), shared_book_) {
        row_.combination = combination;
    }
    Row run(const Limit& limit, const std::string& log, const std::function<bool()>& stop);

  private:
    [[nodiscard]] Status epoch(const Epoch& epoch, std::uint64_t most_rounds, const std::function<bool()>& stop);
    [[nodiscard]] Status rounds(const Epoch& epoch, std::uint32_t count, const std::function<bool()>& stop);
    [[nodiscard]] Status glTurn(const Round& round);
    [[nodiscard]] Status glWait(const Round& round);
    [[nodiscard]] Status vulkanTurns(const Round& round);
    [[nodiscard]] Signals signals();
    [[nodiscard]] Status wait(std::uint64_t value);
    [[nodiscard]] Status settle();
    [[nodiscard]] Status check();
    void judge(std::uint64_t bad_before, std::uint64_t troubles_before, std::uint64_t refused);
    void touches(ledger::ActorId by, const Turn& turn, std::uint32_t wrong_layout = kNoSlot);
    [[nodiscard]] std::uint32_t firstShared(const Turn& turn) const;
    [[nodiscard]] Status countDescriptors(Rebuild rebuild);
    void fail(const Error& error);
    void keepLog(const std::string& log);

    [[nodiscard]] bool faultHere(const Round& round, Side side) const {
        return fault_.kind != Fault::None && fault_.side == side && round.number == fault_.round;
    }
    [[nodiscard]] bool misses(const Round& round, Side side) const {
        return faultHere(round, side) && (fault_.kind == Fault::SkipWait || fault_.kind == Fault::WrongValue);
    }
    [[nodiscard]] bool idleWouldHide(const Round& round) const;
    [[nodiscard]] std::uint64_t handoffsPerRound() const { return course_.slots().shape.fan + 1U; }

    Row row_;
    std::shared_ptr<Book> shared_book_ = std::make_shared<Book>();  // outlives this when the rig is abandoned
    Book& book_ = *shared_book_;
    Planner planner_;
    Course course_;
    Rig rig_;
    Model model_;
    PlannedFault fault_;
    std::uint64_t promised_ = 0;                   // the last host-to-renderer value that OpenGL was to be followed by
    std::uint64_t rescued_ = 0;                    // up to here signals were given in the place of dropped ones
    std::uint64_t to_drop_ = 0;                    // the last that was armed to be dropped
    std::uint64_t next_signal_ = 0, swapped_ = 0;  // of a swap: the second's value, the first's
    std::uint64_t last_gl_wait_ = 0, last_vulkan_wait_ = 0;
    std::uint64_t builds_ = 0;  // of everything that the pattern makes anew
    std::uint64_t first_descriptors_ = 0, last_descriptors_ = 0;
    bool fault_is_due_ = false;
};

}  // namespace sluice::stress
