// SPDX-License-Identifier: MIT
// What will be done, from options and seed alone: which combinations, and for each its epochs. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sluice/result.hpp"
#include "stress/chance.hpp"
#include "stress/options.hpp"

namespace sluice::stress {

inline constexpr std::uint32_t kMaxSets = 4;  ///< also the most outputs of a fan

/// Empty if the combination makes sense; else why not.
[[nodiscard]] std::string whyNot(const Combination& combination);

struct Skipped {
    Combination combination;
    std::string why;
};
struct Matrix {
    std::vector<Combination> runs;
    std::vector<Skipped> skipped;  ///< left out of an "all"
};
/// Every combination that the options mean. Fails with INVALID_ARGUMENT when they name one thing that is not there, or
/// leave nothing to run.
[[nodiscard]] Result<Matrix> matrixOf(const Options& options);

/// Fixed for the whole of a combination's run.
struct Shape {
    std::uint32_t sets = 1;  ///< of the ring
    std::uint32_t fan = 1;   ///< Vulkan submissions per OpenGL signal, each with an output of its own
    bool relay = false;      ///< a thread of the host stands between the two
    bool operator==(const Shape&) const = default;
};

/// What is made anew before an epoch.
enum class Rebuild : std::uint8_t { Nothing, Resources, Everything };

/// Which wait a skipped or wrong wait is, and who writes too early.
enum class Side : std::uint8_t { Gl, Vulkan };

struct PlannedFault {
    Fault kind = Fault::None;
    std::uint32_t round = 0;
    Side side = Side::Gl;
    std::uint32_t delay_us = 0;
    bool operator==(const PlannedFault&) const = default;
};

/// A stretch of rounds, at whose end both sides stand still and every texel is compared.
struct Epoch {
    Rebuild rebuild = Rebuild::Nothing;
    std::uint32_t width = 0, height = 0;
    std::uint32_t rounds = 0;
    bool fresh = false;  ///< the chains begin anew: nothing of what the sets hold is read
    PlannedFault fault;
    bool operator==(const Epoch&) const = default;
};

class Planner {
  public:
    Planner(const Combination& combination, std::uint64_t seed);
    [[nodiscard]] const Shape& shape() const { return shape_; }
    [[nodiscard]] Epoch next();

  private:
    [[nodiscard]] PlannedFault fault(std::uint32_t rounds);

    Combination combination_;
    Chance chance_;
    Shape shape_;
    std::uint64_t epochs_ = 0;
};

/// A seed of this combination's own, so that it runs alone as it runs within a matrix.
[[nodiscard]] std::uint64_t seedOf(const Combination& combination, std::uint64_t seed);

/// The command that runs one combination again.
[[nodiscard]] std::string commandLine(const Combination& combination, std::uint64_t seed, std::uint64_t handoffs);

}  // namespace sluice::stress
