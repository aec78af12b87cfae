// SPDX-License-Identifier: MIT
// One ordering fault each, made on purpose between the real drivers: what the ledger says, what the pixels say, and
// that the host's frame goes on.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <tuple>

#include "ledger_rig.hpp"
#include "sluice/format.hpp"
#include "sluice/ledger/hand_off_feed.hpp"

namespace sluice::host::test {
namespace {

constexpr std::uint64_t kFaultyFrame = 5;
constexpr std::uint64_t kFrames = 12;

constexpr const char* kRace = "race-write-after-write";
constexpr const char* kTimedOut = "wait-timed-out";
constexpr const char* kNotIncreasing = "timeline-not-increasing";

/// A fault and what has to be found with each backend. Nothing: nothing may be.
struct Case {
    FaultKind kind;
    SluiceDirection direction;
    std::uint64_t value = 0;
    std::vector<std::string> bridged, finish;
    std::uint32_t sets = 2;
};

std::string_view nameOf(FaultKind kind) {
    const auto* found =
        std::find_if(kFaultNames.begin(), kFaultNames.end(), [&](const auto& one) { return one.second == kind; });
    return found->first;
}

class OrderingFault : public LedgerTest, public ::testing::WithParamInterface<std::tuple<Case, SluiceTimelineKind>> {
  protected:
    /// A row of the table in docs/results/ledger.md.
    void printRow(FaultKind kind, SluiceDirection direction, SluiceTimelineKind timeline, std::uint32_t sets) const {
        std::string ids;
        for (const auto& [id, count] : found()) {
            ids += (ids.empty() ? "`" : ", `") + id + "`";
        }
        const bool by_pixels = stale_ + torn_ > 0;
        const char* by = ids.empty() ? (by_pixels ? "pixels" : "neither") : by_pixels ? "both" : "ledger";
        fmt::print("| {} | {} | {} | {} | {} | {} | {} stale, {} torn | {} |\n", nameOf(kind),
                   direction == SLUICE_HOST_TO_RENDERER ? "to renderer" : "to host", toString(timeline), sets, by,
                   ids.empty() ? "-" : ids, stale_, torn_, without_fluid_);
    }
};

TEST_P(OrderingFault, IsFound) {
    const auto& [fault, timeline] = GetParam();
    wait_timeout_ns_ = 1'500'000'000;
    ASSERT_NO_FATAL_FAILURE(
        start(timeline, fault.sets, FaultPlan{fault.kind, kFaultyFrame, fault.direction, fault.value}));
    frames(kFrames, 24);
    EXPECT_EQ(fresh_ + stale_ + torn_ + without_fluid_, kFrames);
    finish();
    complaints_.clear();
    printRow(fault.kind, fault.direction, timeline, fault.sets);
    const std::vector<std::string>& expected = timeline == SLUICE_TIMELINE_FINISH ? fault.finish : fault.bridged;
    for (const std::string& id : expected) {
        EXPECT_THAT(found(), ::testing::Contains(::testing::Key(id)));
    }
    // Of a wait left out, the one who left it out is named and what it should have waited for, whenever the queue's
    // events came to the ledger.
    if (fault.kind == FaultKind::SkipWait && !expected.empty()) {
        const bool to_host = fault.direction == SLUICE_RENDERER_TO_HOST;
        for (const ledger::Finding& finding : ledger_->findings()) {
            if (finding.kind != ledger::FindingKind::WriteAfterWrite) {
                continue;
            }
            EXPECT_EQ(finding.second.actor, to_host ? ledger::kGlStream : ledger::kRendererQueue) << finding.sentence;
            EXPECT_THAT(finding.edge, ::testing::HasSubstr(to_host ? "-> host thread:wait(renderer-to-host, 5)"
                                                                   : "-> renderer's queue:wait(host-to-renderer, 9)"));
        }
    }
    if (expected.empty()) {
        EXPECT_THAT(found(), ::testing::IsEmpty());
        EXPECT_EQ(stale_ + torn_, 0U) << "the pixels saw what the ledger did not";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Software, OrderingFault,
    ::testing::Combine(
        ::testing::Values(
            // The finish renderer refuses a frame whose value has not been signalled, so nothing waits for it.
            Case{FaultKind::Drop, SLUICE_HOST_TO_RENDERER, 0, {kTimedOut}, {}},
            Case{FaultKind::Drop, SLUICE_RENDERER_TO_HOST, 0, {kTimedOut}, {kTimedOut}},
            // Late is not wrong.
            Case{FaultKind::Delay, SLUICE_HOST_TO_RENDERER, 50, {}, {}},
            Case{FaultKind::Delay, SLUICE_RENDERER_TO_HOST, 50, {}, {}},
            Case{FaultKind::Duplicate, SLUICE_HOST_TO_RENDERER, 0, {kNotIncreasing}, {kNotIncreasing}},
            Case{FaultKind::Swap, SLUICE_HOST_TO_RENDERER, 0, {kNotIncreasing}, {kNotIncreasing}},
            Case{FaultKind::WrongValue, SLUICE_HOST_TO_RENDERER, 0, {kNotIncreasing, kRace}, {kNotIncreasing}},
            Case{FaultKind::WrongValue, SLUICE_RENDERER_TO_HOST, 0, {kRace}, {kRace}},
            // With finish the submission itself comes after glFinish: the wait says nothing new.
            Case{FaultKind::SkipWait, SLUICE_HOST_TO_RENDERER, 0, {kRace}, {}},
            Case{FaultKind::SkipWait, SLUICE_RENDERER_TO_HOST, 0, {kRace}, {kRace}},
            // With more sets the composite of the next frame waits for this one as well.
            Case{FaultKind::EarlyReuse, SLUICE_RENDERER_TO_HOST, 0, {kRace}, {kRace}, 1}),
        ::testing::Values(SLUICE_TIMELINE_BRIDGED, SLUICE_TIMELINE_FINISH)),
    [](const auto& param) {
        const Case& fault = std::get<0>(param.param);
        std::string name = std::string(nameOf(fault.kind)) +
                           (fault.direction == SLUICE_HOST_TO_RENDERER ? "ToRenderer" : "ToHost") +
                           std::string(toString(std::get<1>(param.param)));
        std::erase(name, '-');
        return name;
    });

}  // namespace
}  // namespace sluice::host::test
