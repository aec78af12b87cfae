// SPDX-License-Identifier: MIT
// The stress test itself, on both APIs: clean runs are clean, and each fault is seen by whom it must be seen.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "sluice/fd.hpp"
#include "stress/descriptors.hpp"
#include "stress/plan.hpp"
#include "stress/rig.hpp"
#include "stress/run.hpp"

namespace sluice::stress::test {
namespace {

constexpr std::uint64_t kSeed = 20;

bool never() {
    return false;
}

/// Of two processes only what is asked for by name: each run starts one.
std::vector<Combination> drivable(const Options& options) {
    std::vector<Combination> runs = matrixOf(options).value().runs;
    std::erase_if(runs, [&](const Combination& one) {
        return one.backend == Backend::Native || one.backend == Backend::Binary ||
               (one.topology == Topology::TwoProcesses && !options.topology);
    });
    return runs;
}

/// GoogleTest wants words without hyphens.
template <typename T>
std::string wordOf(const ::testing::TestParamInfo<T>& info) {
    std::string word(toString(info.param));
    std::replace(word.begin(), word.end(), '-', '_');
    return word;
}

std::string describe(const Row& row) {
    std::string text = commandLine(row.combination, kSeed, row.handoffs) + "\n" + row.failure.value_or("");
    for (const std::string& line : row.told) {
        text += "\n  " + line;
    }
    return text;
}

class EveryPattern : public ::testing::TestWithParam<Pattern> {};

TEST_P(EveryPattern, IsCleanOverEveryBackendResourceAndTopology) {
    Options options;
    options.pattern = GetParam();
    for (const Combination& one : drivable(options)) {
        const Row row = runCombination(one, kSeed, {200, 0.0}, "", never);
        EXPECT_FALSE(row.failure) << describe(row);
        EXPECT_EQ(row.bad_texels, 0U) << describe(row);
        EXPECT_EQ(row.findings, 0U) << describe(row);
        EXPECT_GE(row.handoffs, 200U);
        EXPECT_GE(row.checks, 1U);
    }
}

INSTANTIATE_TEST_SUITE_P(Stress, EveryPattern,
                         ::testing::Values(Pattern::GlToVk, Pattern::VkToGl, Pattern::PingPong, Pattern::Ring,
                                           Pattern::FanOut, Pattern::HostInTheMiddle, Pattern::WaitBeforeSignal,
                                           Pattern::ResizeStorm, Pattern::CreateDestroyStorm),
                         wordOf<Pattern>);

class EveryFault : public ::testing::TestWithParam<Fault> {};

/// One resource, because order does not depend on it; the pixels see what chance lets them see, the ledger everything.
TEST_P(EveryFault, IsSeenByTheLedgerInEveryPattern) {
    Options options;
    options.fault = GetParam();
    options.resource = Resource::R32F;
    for (const Combination& one : drivable(options)) {
        const Row row = runCombination(one, kSeed, {1, 0.0}, "", never);
        EXPECT_FALSE(row.failure) << describe(row);
        EXPECT_GE(row.faults, 1U);
        if (GetParam() == Fault::Delay) {
            EXPECT_EQ(row.unseen, row.faults) << describe(row);
        } else {
            EXPECT_EQ(row.by_ledger, row.faults) << describe(row);
        }
        EXPECT_EQ(row.refused, GetParam() == Fault::Duplicate ? row.faults : 0U);
    }
}

INSTANTIATE_TEST_SUITE_P(Stress, EveryFault,
                         ::testing::Values(Fault::Drop, Fault::Delay, Fault::Duplicate, Fault::SkipWait,
                                           Fault::WrongValue, Fault::EarlyReuse),
                         wordOf<Fault>);

/// They come through the same doors as the others: one backend is enough.
TEST(MoreFaults, SwappedSignalsAndWrongLayoutsAreSeenByTheLedgerInEveryPattern) {
    for (const Fault fault : {Fault::Swap, Fault::WrongLayout}) {
        Options options;
        options.fault = fault;
        options.resource = Resource::R32F;
        options.backend = Backend::Bridged;
        options.topology = Topology::BridgeThread;
        for (const Combination& one : drivable(options)) {
            const Row row = runCombination(one, kSeed, {1, 0.0}, "", never);
            EXPECT_FALSE(row.failure) << describe(row);
            EXPECT_GE(row.faults, 1U);
            EXPECT_EQ(row.by_ledger, row.faults) << describe(row);
            EXPECT_EQ(row.refused, fault == Fault::Swap ? row.faults : 0U);
            EXPECT_EQ(row.at[fault == Fault::Swap ? 0 : 1].by_ledger, row.faults);
            const char* id = fault == Fault::Swap ? "timeline-not-increasing" : "layout-mismatch";
            EXPECT_NE(describe(row).find(id), std::string::npos) << describe(row);
        }
    }
}

/// Processes that this one has started and not yet reaped, zombies too.
std::vector<pid_t> children() {
    std::vector<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "stat");
        std::string line;
        // "PID (name) state parent ...", and the name may hold anything.
        if (file && std::getline(file, line) && line.rfind(')') != std::string::npos) {
            std::istringstream rest(line.substr(line.rfind(')') + 1));
            std::string state;
            pid_t parent = 0;
            rest >> state >> parent;
            if (parent == ::getpid()) {
                found.push_back(std::stoi(entry.path().filename()));
            }
        }
    }
    return found;
}

TEST(TwoProcesses, AreCleanInEveryPatternAndResource) {
    std::uint32_t turn = 0;
    for (const Resource resource : {Resource::Colour, Resource::D32F, Resource::R32F, Resource::Buffer}) {
        Options options;
        options.topology = Topology::TwoProcesses;
        options.resource = resource;
        for (const Combination& one : drivable(options)) {
            if (turn++ % 4 != 0) {
                continue;  // 9 patterns and 4 resources: each of either comes up
            }
            const Row row = runCombination(one, kSeed, {300, 0.0}, "", never);
            EXPECT_FALSE(row.failure) << describe(row);
            EXPECT_EQ(row.bad_texels, 0U) << describe(row);
            EXPECT_EQ(row.findings, 0U) << describe(row);
            EXPECT_GE(row.handoffs, 300U);
        }
    }
    EXPECT_EQ(turn, 36U);
    EXPECT_TRUE(children().empty());
}

TEST(TwoProcesses, EachFaultIsSeenByTheLedger) {
    for (const Fault fault : {Fault::Drop, Fault::Delay, Fault::Duplicate, Fault::SkipWait, Fault::WrongValue,
                              Fault::EarlyReuse, Fault::Swap, Fault::WrongLayout}) {
        const Combination one{Pattern::Ring, Backend::Bridged, Resource::R32F, Topology::TwoProcesses, fault};
        const Row row = runCombination(one, kSeed, {1, 0.0}, "", never);
        EXPECT_FALSE(row.failure) << describe(row);
        EXPECT_GE(row.faults, 1U);
        EXPECT_EQ(fault == Fault::Delay ? row.unseen : row.by_ledger, row.faults) << describe(row);
    }
}

/// Whether it dies within a call or while the host waits for its signal is left to chance: the end is the same.
Row runAndKill(std::vector<pid_t>& killed) {
    int asked = 0;
    const Combination one{Pattern::Ring, Backend::Bridged, Resource::R32F, Topology::TwoProcesses, Fault::None};
    return runCombination(one, kSeed, {}, "", [&] {
        if (++asked == 50) {
            killed = children();
            std::for_each(killed.begin(), killed.end(), [](pid_t pid) { ::kill(pid, SIGKILL); });
        }
        return false;
    });
}

TEST(TwoProcesses, OneThatIsKilledIsToldOnceAndLeavesNothing) {
    std::vector<pid_t> killed;
    const Row row = runAndKill(killed);
    ASSERT_EQ(killed.size(), 1U);
    ASSERT_TRUE(row.failure);
    EXPECT_NE(row.failure->find("Vulkan process " + std::to_string(killed[0]) + ": was killed by signal 9 (SIGKILL)"),
              std::string::npos)
        << *row.failure;
    EXPECT_NE(row.failure->find("--topology bridge-thread"), std::string::npos) << *row.failure;
    EXPECT_FALSE(row.stuck);
    EXPECT_FALSE(row.refused_here);
    EXPECT_TRUE(children().empty());
    // What drivers open once for the whole process is theirs; another such run must add nothing.
    const std::uint64_t open = openDescriptors();
    EXPECT_TRUE(runAndKill(killed).failure);
    EXPECT_EQ(openDescriptors(), open);
}

TEST(Pixels, SeeAReadThatDoesNotWait) {
    // A race is lost only sometimes: enough tries, no rate.
    const Combination one{Pattern::VkToGl, Backend::Finish, Resource::Colour, Topology::OneThread, Fault::SkipWait};
    std::uint64_t seen = 0;
    for (std::uint64_t seed = 1; seed <= 20 && seen == 0; ++seed) {
        seen += runCombination(one, seed, {300, 0.0}, "", never).by_pixels;
    }
    EXPECT_GT(seen, 0U);
}

TEST(Backend, ThatTheDriversLackIsRefusedByName) {
    for (const Backend backend : {Backend::Native, Backend::Binary}) {
        const Combination one{Pattern::PingPong, backend, Resource::Colour, Topology::BridgeThread, Fault::None};
        const Row row = runCombination(one, kSeed, {10, 0.0}, "", never);
        ASSERT_TRUE(row.failure);
        EXPECT_TRUE(row.refused_here);
        EXPECT_EQ(row.handoffs, 0U);
        EXPECT_NE(row.failure->find(toString(backend)), std::string::npos) << *row.failure;
    }
}

TEST(Stop, EndsARunInGoodOrder) {
    int asked = 0;
    const Combination one{Pattern::Ring, Backend::Bridged, Resource::Buffer, Topology::BridgeThread, Fault::None};
    const Row row = runCombination(one, kSeed, {}, "", [&asked] { return ++asked > 100; });
    EXPECT_FALSE(row.failure) << describe(row);
    EXPECT_TRUE(row.interrupted);
    EXPECT_GT(row.handoffs, 0U);
}

/// One descriptor is opened on the way, as a leak would, between the second build and the last.
TEST(Descriptors, NotOneMayBeLeftOverAndTheLogIsKept) {
    for (const Pattern pattern : {Pattern::ResizeStorm, Pattern::CreateDestroyStorm}) {
        const Combination one{pattern, Backend::Bridged, Resource::R32F, Topology::BridgeThread, Fault::None};
        const std::string log =
            ::testing::TempDir() + "descriptors-" + std::to_string(static_cast<int>(pattern)) + ".sluicelog";
        UniqueFd leaked;
        int asked = 0;
        const Row row = runCombination(one, kSeed, {400, 0.0}, log, [&] {
            if (++asked == 150) {
                leaked = UniqueFd(::open("/dev/null", O_RDONLY | O_CLOEXEC));
            }
            return false;
        });
        ASSERT_TRUE(leaked.valid());
        ASSERT_TRUE(row.failure);
        EXPECT_NE(row.failure->find("descriptors"), std::string::npos) << describe(row);
        EXPECT_EQ(row.log, log);
        EXPECT_EQ(row.log_error, "");
        EXPECT_TRUE(std::filesystem::remove(log));
    }
}

TEST(Log, ThatCannotBeWrittenIsNamed) {
    const Combination one{Pattern::ResizeStorm, Backend::Bridged, Resource::R32F, Topology::BridgeThread, Fault::None};
    UniqueFd leaked;
    int asked = 0;
    const Row row = runCombination(one, kSeed, {200, 0.0}, ::testing::TempDir(), [&] {
        if (++asked == 50) {
            leaked = UniqueFd(::open("/dev/null", O_RDONLY | O_CLOEXEC));
        }
        return false;
    });
    ASSERT_TRUE(row.failure);
    EXPECT_EQ(row.log, "");
    EXPECT_NE(row.log_error.find(::testing::TempDir()), std::string::npos) << row.log_error;
}

/// What a bridge thread does after the run has given up on a stuck queue.
int signalThroughAnAbandonedLink() {
    const Combination one{Pattern::HostInTheMiddle, Backend::Bridged, Resource::R32F, Topology::BridgeThread,
                          Fault::None};
    auto book = std::make_shared<Book>();
    const std::weak_ptr<Book> watched = book;
    auto rig = std::make_unique<Rig>(one, Planner(one, kSeed).shape(), std::move(book));
    if (!rig->build(Rebuild::Everything, 8, 8)) {
        return 2;
    }
    Link& link = rig->link();
    rig->abandon();
    rig.reset();
    if (watched.expired()) {
        return 3;
    }
    return link.api().timeline_signal(link.renderer(), 1) == SLUICE_OK ? 0 : 4;
}

TEST(AbandonedRigDeathTest, LeavesTheBookToItsThreads) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(std::_Exit(signalThroughAnAbandonedLink()), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace sluice::stress::test
