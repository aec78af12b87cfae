// SPDX-License-Identifier: MIT
// Misfortunes of a renderer or of the machine, made on purpose: what the host owes each time. Prints the rows of
// docs/results/host-faults.md.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>

#include "gl_test.hpp"
#include "recovery_rig.hpp"

namespace sluice::host::test {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kFaultyFrame = 4;
constexpr int kFrames = 14;

struct Case {
    HostFaultKind kind;
    std::uint64_t value;
    const char* frames;       ///< 'f' with fluid, '-' without
    std::uint32_t renderers;  ///< created in all
    const char* said;         ///< somewhere in the log or in what a call answered; nullptr: nothing is
};

std::string_view nameOf(HostFaultKind kind) {
    const auto* found = std::find_if(kHostFaultNames.begin(), kHostFaultNames.end(),
                                     [&](const auto& one) { return one.second == kind; });
    return found->first;
}

std::size_t heapInUse() {
    return mallinfo2().uordblks;
}

class HostFaultTest : public RecoveryTest, public ::testing::WithParamInterface<Case> {};

TEST_P(HostFaultTest, CostsNoMoreThanItMust) {
    const Case& fault = GetParam();
    // Drivers keep what they need for a second renderer from the first time on.
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    run(1);
    host_.reset();
    drawn_ = 0;
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.host_fault = HostFault{fault.kind, kFaultyFrame, fault.value};
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    std::string seen = run(3);
    const int descriptors = openDescriptors();
    const std::size_t heap = heapInUse();
    double slowest_ms = 0.0;
    double without_ms = 0.0;  // from the first frame without fluid to the end of the next one with it
    bool without = false;
    while (seen.size() < kFrames) {
        const Clock::time_point start = Clock::now();
        seen += run(1);
        const std::chrono::duration<double, std::milli> took = Clock::now() - start;
        slowest_ms = std::max(slowest_ms, took.count());
        without_ms += without || seen.back() == '-' ? took.count() : 0.0;
        without = seen.back() == '-';
    }
    EXPECT_EQ(seen, fault.frames);
    EXPECT_EQ(host_->renderers(), fault.renderers);
    // A host that has given up has less than it had; none has more.
    EXPECT_TRUE(descriptorsReturnTo(descriptors)) << openDescriptors() << " instead of " << descriptors;
    std::vector<std::string> all = complaints_;
    all.insert(all.end(), failures_.begin(), failures_.end());
    if (fault.said != nullptr) {
        EXPECT_THAT(all, Contains(HasSubstr(fault.said)));
    }
    fmt::print("| {}{} | {} | {} | {:.0f} | {:.0f} | {} | {} | {} | {} | {} |\n", nameOf(fault.kind),
               fault.value != 0 ? fmt::format("={}", fault.value) : "", failures_.empty() ? "-" : failures_.front(),
               std::count(seen.begin(), seen.end(), '-'), without_ms, slowest_ms, host_->renderers(), descriptors,
               openDescriptors(), heap / 1024, heapInUse() / 1024);
    complaints_.clear();
}

INSTANTIATE_TEST_SUITE_P(
    Software, HostFaultTest,
    ::testing::Values(
        Case{HostFaultKind::DeviceLost, 0, "fff-ffffffffff", 2, "submit_frame says that the device is lost"},
        // Tries at frames 5, 7 and 11; the frames between are the host's.
        Case{HostFaultKind::DeviceLost, 2, "fff-------ffff", 2, "try 2 of 5 failed, the next one in 4 frames"},
        Case{HostFaultKind::PluginError, 1, "fff-ffffffffff", 1, "submit_frame fails and says no more"},
        Case{HostFaultKind::PluginError, 2, "fff--fffffffff", 2, "useless from frame"},
        Case{HostFaultKind::Hang, 300, "ffffffffffffff", 1, nullptr},
        Case{HostFaultKind::OutOfFds, 1, "fff---ffffffff", 2,
             "file descriptors 0 are free, for the injected fault has lowered their limit"},
        Case{HostFaultKind::OutOfMemory, 1, "fff---ffffffff", 2, "create finds no memory"},
        Case{HostFaultKind::ContextLost, 0, "fff-----------", 1, "create another context"}),
    [](const auto& param) {
        std::string name = std::string(nameOf(param.param.kind)) + std::to_string(param.param.value);
        std::erase(name, '-');
        return name;
    });

TEST_F(RecoveryTest, ACallThatDoesNotComeBackIsNamedWhileItLasts) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.call_alarm_ns = 5'000'000;
    std::atomic<int> seen = 0;
    wanted.log = [&](SluiceLogLevel, std::string_view text) {
        if (text.find("has not come back from submit_frame of frame 2") != std::string_view::npos) {
            ++seen;
            control_->release = true;  // without that line the call would never return
        }
    };
    Result<std::unique_ptr<FluidHost>> host = FluidHost::create(*library_, wanted);
    ASSERT_TRUE(host) << host.error().message();
    host_ = std::move(host).value();
    ASSERT_NO_FATAL_FAILURE(makeScreen(kEchoWidth, kEchoHeight));
    control_->hang_frame = 2;
    EXPECT_EQ(run(3), "fff");
    EXPECT_EQ(seen, 1) << "said once";
    EXPECT_EQ(host_->renderers(), 1U);
    host_.reset();
}

TEST_F(RecoveryTest, AfterALostContextEverythingIsMadeAnewInAnother) {
    FluidHostConfig wanted = recovering(SLUICE_TIMELINE_BRIDGED);
    wanted.host_fault = HostFault{HostFaultKind::ContextLost, 2, 0};
    ASSERT_NO_FATAL_FAILURE(begin(wanted));
    EXPECT_EQ(run(4), "f---");
    EXPECT_THAT(complaints_, SizeIs(1)) << "said once";
    EXPECT_THAT(failures_, Each(HasSubstr("GL context: it has been reset")));
    EXPECT_FALSE(host_->resize(64, 64));
    const std::uint32_t submits = control_->submits;
    host_.reset();
    screen_.reset();
    context_.reset();
    Result<GlContext> context = GlContext::create();
    ASSERT_TRUE(context) << context.error().message();
    context_.emplace(std::move(context).value());
    ASSERT_TRUE(context_->makeCurrent());
    EXPECT_THAT(contextLoss(), IsEmpty());
    drawn_ = 0;
    complaints_.clear();
    ASSERT_NO_FATAL_FAILURE(begin(recovering(SLUICE_TIMELINE_BRIDGED)));
    EXPECT_EQ(run(2), "ff");
    EXPECT_EQ(control_->submits, submits + 2);
}

}  // namespace
}  // namespace sluice::host::test
