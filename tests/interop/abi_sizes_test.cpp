// SPDX-License-Identifier: MIT
// How a struct crosses when one side knows more fields of it than the other.
#include "sluice/abi_sizes.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using sluice::Status;

/// Version 1.0, and what it became in 1.1.
struct Old {
    std::uint32_t struct_size;
    std::uint32_t first;
    static constexpr std::size_t kMinimum = 8;
};
struct New {
    std::uint32_t struct_size;
    std::uint32_t first;
    std::uint64_t second;
    void (*third)();
    static constexpr std::size_t kMinimum = 8;
};
static_assert(sizeof(Old) == 8 && sizeof(New) == 24);

void noop() {}

TEST(AbiSizes, ANewReaderSeesZeroWhereAnOldWriterEnds) {
    const New given{sizeof(Old), 7, 99, noop};  // what lies behind the old struct is none of the reader's
    ASSERT_TRUE(sluice::checkAbiStruct(&given, "thing"));
    const New read = sluice::readAbiStruct(given);
    EXPECT_EQ(read.struct_size, sizeof(New));
    EXPECT_EQ(read.first, 7U);
    EXPECT_EQ(read.second, 0U);
    EXPECT_EQ(read.third, nullptr);
}

TEST(AbiSizes, AnOldReaderIgnoresWhatItDoesNotKnow) {
    const std::array<Old, 2> given{{{sizeof(New), 7}, {1, 2}}};
    ASSERT_TRUE(sluice::checkAbiStruct(given.data(), "thing"));
    EXPECT_EQ(sluice::readAbiStruct(given[0]).first, 7U);
}

TEST(AbiSizes, WritingStopsAtTheShorterSide) {
    New old_reader{sizeof(Old), 0, 99, nullptr};
    ASSERT_TRUE(sluice::writeAbiStruct(&old_reader, New{sizeof(New), 5, 6, noop}, "thing"));
    EXPECT_EQ(old_reader.first, 5U);
    EXPECT_EQ(old_reader.second, 99U);
    EXPECT_EQ(old_reader.struct_size, sizeof(Old));

    std::array<Old, 2> new_reader{{{sizeof(New), 0}, {1, 2}}};
    ASSERT_TRUE(sluice::writeAbiStruct(new_reader.data(), Old{sizeof(Old), 5}, "thing"));
    EXPECT_EQ(new_reader[0].first, 5U);
    EXPECT_EQ(new_reader[0].struct_size, sizeof(Old)) << "so that the reader knows where the answer ends";
    EXPECT_EQ(new_reader[1].first, 2U);
}

TEST(AbiSizes, BelowTheMinimumIsRefusedByName) {
    for (const std::uint32_t size : {0U, 4U, 7U}) {
        New given{size, 1, 2, nullptr};
        const Status status = sluice::checkAbiStruct(&given, "thing");
        ASSERT_FALSE(status) << size;
        EXPECT_EQ(status.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
        EXPECT_EQ(status.error().message(),
                  "thing: struct_size is " + std::to_string(size) + ", at least 8 is needed (set it to sizeof)");
        EXPECT_FALSE(sluice::writeAbiStruct(&given, New{}, "thing"));
        EXPECT_EQ(given.first, 1U);
    }
    EXPECT_FALSE(sluice::checkAbiStruct<New>(nullptr, "thing"));
}

// Padding at the end does not belong to ABI 1.0: a later field may stand there.
static_assert(sluice::kAbiMinimum<SluiceFrame> == 380 && sizeof(SluiceFrame) == 624);
static_assert(sluice::kAbiMinimum<SluiceSimulation> == 112 && sluice::kAbiMinimum<SluiceSimulationStats> == 592);
static_assert(sluice::kAbiMinimum<SluiceBodies> == 1552 && sluice::kAbiMinimum<SluiceBodyTarget> == 32);
static_assert(sluice::kAbiMinimum<SluiceFlow> == 1320 && sluice::kAbiMinimum<SluiceStart> == 24);
static_assert(sluice::kAbiMinimum<SluiceFrameStats> == 2596 && sizeof(SluiceFrameStats) == 2600);
static_assert(sluice::kAbiMinimum<SluiceError> == 520 && sluice::kAbiMinimum<SluiceTraceEvent> == 64);
static_assert(sluice::kAbiMinimum<SluiceImageExport> == 40 && sluice::kAbiMinimum<SluiceHostServices> == 56);
static_assert(sluice::kAbiMinimum<SluiceHostCapabilities> == 412);
static_assert(sluice::kAbiMinimum<SluiceRendererCapabilities> == 428);
static_assert(sluice::kAbiMinimum<SluiceParticles> == 40 && sluice::kAbiMinimum<SluiceEnvironment> == 24);
static_assert(sluice::kAbiMinimum<SluiceSceneNeeds> == 136 && sluice::kAbiMinimum<SluiceCreateInfo> == 444);
static_assert(sluice::kAbiMinimum<SluiceRendererInfo> == 516 && sluice::kAbiMinimum<SluiceRendererApi> == 144);

}  // namespace
