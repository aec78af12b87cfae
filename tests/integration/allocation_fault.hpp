// SPDX-License-Identifier: MIT
// The Nth allocation of Sluice's own code fails. Drivers, which are not written for it, keep theirs.
#pragma once

#include <cstdint>

namespace sluice::host::test {

/// While it lives, the allocations of this thread that were asked for by this program or by the renderer's library
/// (both in their own code and through libstdc++ or fmt) are counted, and number `nth` throws std::bad_alloc. 0: none
/// does. One at a time. The library must be loaded.
class FailingAllocation {
  public:
    explicit FailingAllocation(std::uint64_t nth);
    FailingAllocation(const FailingAllocation&) = delete;
    FailingAllocation& operator=(const FailingAllocation&) = delete;
    ~FailingAllocation();

    [[nodiscard]] std::uint64_t counted() const;
    [[nodiscard]] bool failed() const;
};

}  // namespace sluice::host::test
