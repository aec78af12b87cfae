// SPDX-License-Identifier: MIT
// Frames through the real drivers with a ledger, and what ledger and pixels say to them.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "shim_rig.hpp"
#include "sluice/ledger/live.hpp"

namespace sluice::host::test {

class LedgerTest : public ShimTest {
  protected:
    /// A host of kEchoWidth x kEchoHeight, its screen and its ledger.
    void start(SluiceTimelineKind kind, std::uint32_t sets, const std::optional<FaultPlan>& fault = std::nullopt,
               std::unique_ptr<ledger::LogWriter> log = nullptr);
    /// `count` frames of the usual cadence. A frame whose submit or composite fails is counted and goes on without
    /// fluid; of all others the pixels are looked at and told to the ledger. The screen always shows the host's frame.
    void frames(std::uint64_t count, int layers = 4);
    /// Ends host and ledger, in this order.
    void finish();
    /// Times seen, by id.
    [[nodiscard]] std::map<std::string, std::uint64_t> found() const;

    std::unique_ptr<ledger::LiveLedger> ledger_;
    std::uint64_t wait_timeout_ns_ = 10'000'000'000ULL;
    std::uint32_t flags_ = 0;
    std::uint64_t without_fluid_ = 0, fresh_ = 0, stale_ = 0, torn_ = 0;
    std::vector<std::string> failures_;  ///< what submit and composite said
};

}  // namespace sluice::host::test
