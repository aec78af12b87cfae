// SPDX-License-Identifier: MIT
// Where the bodies of a simulation are at the end of each value that can still be drawn, and what the fluid did to
// them.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "simulation/bodies.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::vk {

/// add() and close() on the simulation's thread, at() on any.
class BodyReports {
  public:
    /// `values`: how many are kept; `start`: the bodies before the first.
    BodyReports(std::size_t values, std::span<const BodyState> start);

    /// A step of the value under way: force and torque are means over its steps.
    void add(std::span<const BodyState> bodies, double seconds);
    /// The end of `value`.
    void close(std::uint64_t value, std::span<const BodyState> bodies);
    /// Value 0: the last one. NOT_READY if `value` has not ended, INVALID_ARGUMENT if it is kept no more.
    [[nodiscard]] Result<SluiceBodies> at(std::uint64_t value) const;

  private:
    struct Push {
        Vector force{}, torque{};  ///< times seconds
    };
    std::vector<Push> pushes_;
    double seconds_ = 0.0;

    mutable std::mutex mutex_;  ///< guards what follows
    std::vector<SluiceBodies> kept_;
    SluiceBodies last_{};
};

}  // namespace sluice::vk
