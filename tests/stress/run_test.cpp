// SPDX-License-Identifier: MIT
// The stress test itself, on both APIs: clean runs are clean, and each fault is seen by whom it must be seen.
#include <gtest/gtest.h>

#include <algorithm>

#include "stress/plan.hpp"
#include "stress/run.hpp"

namespace sluice::stress::test {
namespace {

constexpr std::uint64_t kSeed = 20;

bool never() {
    return false;
}

std::vector<Combination> drivable(const Options& options) {
    std::vector<Combination> runs = matrixOf(options).value().runs;
    std::erase_if(
        runs, [](const Combination& one) { return one.backend == Backend::Native || one.backend == Backend::Binary; });
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

}  // namespace
}  // namespace sluice::stress::test
