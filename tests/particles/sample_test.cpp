// SPDX-License-Identifier: MIT
// Real sets: those that come with the workshop (../shared/particles beside the checkout), if they are there. Their
// numbers are those of that folder's README.
#include <algorithm>

#include "files.hpp"

namespace sluice::particles::test {
namespace {

struct Sample {
    const char* file;
    std::size_t count;
    float radius;
    float low, high;  ///< of every coordinate
};

class SharedSample : public testing::TestWithParam<Sample> {};

TEST_P(SharedSample, HasTheCountRadiusAndBoxOfItsReadme) {
    const std::filesystem::path path = std::filesystem::path(SLUICE_SHARED_PARTICLES) / GetParam().file;
    if (!std::filesystem::exists(path)) {
        GTEST_SKIP() << path << " is not here";
    }
    const Result<ParticleSet> set = load(path);
    ASSERT_TRUE(set.ok()) << set.error().message();
    EXPECT_EQ(set.value().count(), GetParam().count);
    EXPECT_NEAR(set.value().radius, GetParam().radius, 5e-6F);
    const auto [low, high] = std::ranges::minmax_element(set.value().position);
    EXPECT_GE(*low, GetParam().low);
    EXPECT_LE(*high, GetParam().high);
}

INSTANTIATE_TEST_SUITE_P(Table, SharedSample,
                         testing::Values(Sample{"p20k.pos", 18770, 0.02527F, -1.01F, 2.1F},
                                         Sample{"p100k.pos", 96161, 0.01478F, -1.01F, 2.1F},
                                         Sample{"p500k.pos", 488451, 0.00864F, -1.01F, 2.1F},
                                         Sample{"sdg.0040.pos", 64830, 0.00625F, 0.0F, 1.0F},
                                         Sample{"sdg.0120.pos", 64830, 0.00625F, 0.0F, 1.0F}));

}  // namespace
}  // namespace sluice::particles::test
