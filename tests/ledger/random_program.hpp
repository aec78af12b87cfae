// SPDX-License-Identifier: MIT
// Random programs that are in order by construction, mutations of them, and the logs that they may leave.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "oracle.hpp"
#include "sluice/ledger/ledger.hpp"

namespace sluice::ledger::test {

/// Decisions taken from a list of bytes, so that a shorter list is a smaller program and rapidcheck can shrink it.
class Choices {
  public:
    explicit Choices(std::vector<std::uint8_t> bytes) : bytes_(std::move(bytes)) {}
    [[nodiscard]] bool empty() const { return next_ >= bytes_.size(); }
    std::uint32_t below(std::uint32_t count) { return empty() ? 0 : bytes_[next_++] % count; }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t next_ = 0;
};

/// `simple` programs keep to one signaller per sync and use a binary once: then what a mutation does to them does not
/// hang on the order of the log.
[[nodiscard]] Program wellOrdered(Choices& choices, bool simple);

/// Breaks one thing, and says what.
std::string mutate(Program& program, Choices& choices);

/// One of the logs of `program`: each actor's order kept, submissions around their batches, waits wherever they fall.
[[nodiscard]] std::vector<Event> interleave(const Program& program, std::uint32_t seed);

/// A ledger that was told the declarations and the log. Performance findings are off: random waits are often useless.
[[nodiscard]] Ledger replay(const Program& program, const std::vector<Event>& log, std::size_t prune_above = 64);

[[nodiscard]] std::string describe(const Program& program);

}  // namespace sluice::ledger::test
