// SPDX-License-Identifier: MIT
// The chain of contents: what it is made of decides which broken hand-offs it can show.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "stress/chain.hpp"

namespace sluice::stress::test {
namespace {

constexpr std::uint32_t k24 = 0xFFFFFF, k32 = 0xFFFFFFFF;

RC_GTEST_PROP(Mix, KeepsTwoTexelsApartForEver, (std::uint32_t a, std::uint32_t b, std::uint32_t salt, bool wide)) {
    const std::uint32_t mask = wide ? k32 : k24;
    RC_PRE((a & mask) != (b & mask));
    RC_ASSERT(mix(a & mask, 0, salt, 7, mask) != mix(b & mask, 0, salt, 7, mask));
    RC_ASSERT(mix(0, a & mask, salt, 7, mask) != mix(0, b & mask, salt, 7, mask));
}

RC_GTEST_PROP(Mix, StaysInItsWord, (std::uint32_t x, std::uint32_t word, std::uint32_t salt, std::uint32_t index)) {
    RC_ASSERT(mix(x & k24, word & k24, salt, index, k24) <= k24);
}

TEST(Mix, DoesNotCommuteAndTellsTexelsApart) {
    const auto twice = [](std::uint32_t first, std::uint32_t second) {
        return mix(0, mix(0, 5, first, 3, k24), second, 3, k24);
    };
    EXPECT_NE(twice(saltOf(1, 1), saltOf(1, 2)), twice(saltOf(1, 2), saltOf(1, 1)));
    EXPECT_NE(mix(0, 0, 1, 0, k24), mix(0, 0, 1, 1, k24));
}

TEST(Salt, DoesNotComeTwiceSoon) {
    std::set<std::uint32_t> seen;
    for (std::uint64_t turn = 0; turn < 5000; ++turn) {
        seen.insert(saltOf(42, turn));
    }
    EXPECT_GT(seen.size(), 4990U);
}

template <typename T>
std::vector<std::byte> bytesOf(const std::vector<T>& values) {
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

TEST(Decode, TakesExactFloatsAndNoOthers) {
    const auto depths = bytesOf<float>({0.0F, 1.0F / 16777216.0F, 16777215.0F / 16777216.0F, 3e-9F, 1.0F, -1.0F});
    EXPECT_EQ(decode(Resource::D32F, depths), (Words{0, 1, 0xFFFFFF, k32, k32, k32}));
    const auto numbers = bytesOf<float>({0.0F, 5.0F, 16777215.0F, 16777216.0F, 0.5F});
    EXPECT_EQ(decode(Resource::R32F, numbers), (Words{0, 5, 0xFFFFFF, k32, k32}));
    EXPECT_EQ(decode(Resource::Colour, bytesOf<std::uint32_t>({0x04030201})), (Words{0x04030201}));
}

/// What the model makes of texels.
struct Judged {
    Finding finding{};
    std::uint64_t bad = 0, version = 0;
};

/// A slot that has gone through four versions.
class ModelTest : public ::testing::Test {
  protected:
    void SetUp() override {
        model_.restart(Resource::R32F, 8, 2);
        for (std::uint64_t version = 1; version <= 4; ++version) {
            Turn turn;
            turn.inputs = version == 1 ? std::vector<std::uint32_t>{} : std::vector<std::uint32_t>{0};
            turn.version = version;
            turn.salt = saltOf(9, version);
            model_.apply(turn);
            Words words(8);
            for (std::uint32_t i = 0; i < 8; ++i) {
                words[i] = mix(0, version == 1 ? 0 : versions_.back()[i], turn.salt, i, k24);
            }
            versions_.push_back(words);
        }
    }
    Judged judge(const Words& found) {
        Judged judged;
        judged.finding = model_.compare(0, found, judged.bad, judged.version);
        return judged;
    }
    Model model_;
    std::vector<Words> versions_;
};

TEST_F(ModelTest, KnowsTheNewestVersion) {
    const Judged judged = judge(versions_[3]);
    EXPECT_EQ(judged.finding, Finding::Right);
    EXPECT_EQ(judged.bad, 0U);
    EXPECT_EQ(judged.version, 4U);
}

TEST_F(ModelTest, CallsAnOlderOneStaleAndNamesIt) {
    const Judged judged = judge(versions_[1]);
    EXPECT_EQ(judged.finding, Finding::Stale);
    EXPECT_EQ(judged.bad, 8U);
    EXPECT_EQ(judged.version, 2U);
}

TEST_F(ModelTest, CallsAMixtureTorn) {
    Words half = versions_[3];
    std::copy(versions_[2].begin(), versions_[2].begin() + 3, half.begin());
    const Judged judged = judge(half);
    EXPECT_EQ(judged.finding, Finding::Torn);
    EXPECT_EQ(judged.bad, 3U);
}

TEST_F(ModelTest, CallsWhatItNeverMadeWrong) {
    Words other = versions_[3];
    other[5] ^= 1U;
    EXPECT_EQ(judge(other).finding, Finding::Wrong);
    EXPECT_EQ(judge(other).bad, 1U);
    EXPECT_EQ(judge({}).finding, Finding::Wrong);
}

}  // namespace
}  // namespace sluice::stress::test
