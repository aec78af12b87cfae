// SPDX-License-Identifier: MIT
// Vector clocks, and what an actor knows: what has happened before it, and which memory of that it can see.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace sluice::ledger {

/// Index into the ledger's own tables; never an id of the log, which may be any number.
using Slot = std::uint32_t;

/// A point in one actor's life. An actor's tick rises when it publishes its clock, so that two events with one tick
/// have been published together or not at all.
struct Epoch {
    Slot actor = 0;
    std::uint64_t tick = 0;  ///< 0: no such event; the first tick is 1
};

/// Ticks by actor slot; absent ones are 0. The first eight lie inside, so that a usual program allocates nothing.
class Clock {
  public:
    [[nodiscard]] std::uint64_t get(Slot actor) const {
        if (actor < kInside) {
            return inside_[actor];
        }
        return actor - kInside < more_.size() ? more_[actor - kInside] : 0;
    }
    void raise(Epoch epoch) {
        if (epoch.actor >= kInside && epoch.actor - kInside >= more_.size()) {
            more_.resize(epoch.actor - kInside + 1);
        }
        auto& tick = epoch.actor < kInside ? inside_[epoch.actor] : more_[epoch.actor - kInside];
        tick = std::max(tick, epoch.tick);
    }
    /// True when anything rose.
    bool join(const Clock& other);
    [[nodiscard]] bool covers(const Clock& other) const;
    [[nodiscard]] bool covers(Epoch epoch) const { return epoch.tick <= get(epoch.actor); }
    [[nodiscard]] Slot size() const { return static_cast<Slot>(kInside + more_.size()); }
    [[nodiscard]] std::size_t bytes() const { return more_.capacity() * sizeof(std::uint64_t); }

  private:
    static constexpr Slot kInside = 8;
    std::array<std::uint64_t, kInside> inside_{};
    std::vector<std::uint64_t> more_;
};

/// Memory that is visible, where that is less than what is ordered: after waits on syncs with lists.
struct Sight {
    Clock all;                                   ///< visible whatever the resource
    std::vector<std::pair<Slot, Clock>> listed;  ///< beyond that, by resource

    [[nodiscard]] const Clock* find(Slot resource) const;
    Clock& at(Slot resource);
};

/// What has happened before some point, and what of it can be seen there.
class Knowledge {
  public:
    Knowledge() = default;
    Knowledge(const Knowledge& other);
    Knowledge& operator=(const Knowledge& other);
    Knowledge(Knowledge&&) noexcept = default;
    Knowledge& operator=(Knowledge&&) noexcept = default;
    ~Knowledge() = default;

    [[nodiscard]] const Clock& order() const { return order_; }
    [[nodiscard]] const Sight* sight() const { return sight_.get(); }
    [[nodiscard]] const Clock& visible() const { return sight_ ? sight_->all : order_; }

    void raise(Epoch epoch);
    /// Both order and sight; true when anything rose.
    bool absorb(const Knowledge& other);
    /// Order alone; see() adds what becomes visible. settle() afterwards.
    bool absorbOrder(const Clock& other);
    bool see(Slot resource, const Clock& seen);
    bool seeAll(const Clock& seen);
    /// Forgets the distinction where it has become empty.
    void settle();

    [[nodiscard]] bool sees(Epoch epoch, Slot resource) const;
    [[nodiscard]] std::size_t bytes() const;

  private:
    Clock order_;
    std::unique_ptr<Sight> sight_;  ///< none: all that is ordered is visible
};

}  // namespace sluice::ledger
