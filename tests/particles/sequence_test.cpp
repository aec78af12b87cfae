// SPDX-License-Identifier: MIT
#include <rapidcheck.h>

#include <cinttypes>
#include <cstdio>

#include "files.hpp"

namespace sluice::particles::test {
namespace {

std::string pathOf(const std::string& pattern, std::int64_t frame) {
    const Result<std::filesystem::path> path = Sequence{pattern}.path(frame);
    return path ? path.value().string() : path.error().message();
}

TEST(Sequence, PatternsThatNumber) {
    EXPECT_EQ(pathOf("frame_%04d.pos", 7), "frame_0007.pos");
    EXPECT_EQ(pathOf("frame_%d.pos", 123456), "frame_123456.pos");
    EXPECT_EQ(pathOf("frame_%3i.pos", 7), "frame_  7.pos");
    EXPECT_EQ(pathOf("a%%b/%05u.bgeo.gz", 40), "a%b/00040.bgeo.gz");
    EXPECT_EQ(pathOf("frame_####.pos", 7), "frame_0007.pos");
    EXPECT_EQ(pathOf("frame_#.pos", 12345), "frame_12345.pos");
    EXPECT_EQ(pathOf("frame_%04d.pos", -5), "frame_-005.pos");
    EXPECT_TRUE(Sequence{"frame_%04d.pos"}.numbered());
    EXPECT_TRUE(Sequence{"frame_##.pos"}.numbered());
}

TEST(Sequence, WithoutANumberItIsOneFile) {
    EXPECT_FALSE(Sequence{"pool.pos"}.numbered());
    EXPECT_EQ(pathOf("pool.pos", 7), "pool.pos");
    EXPECT_FALSE(Sequence{"100%%.pos"}.numbered());
    EXPECT_EQ(pathOf("100%%.pos", 7), "100%.pos");
}

class BadPattern : public testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(BadPattern, IsRefused) {
    const auto& [pattern, part] = GetParam();
    const Result<std::filesystem::path> path = Sequence{pattern}.path(1);
    ASSERT_FALSE(path.ok());
    EXPECT_EQ(path.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(path.error().message(), testing::HasSubstr(part));
    EXPECT_TRUE(pattern[0] == '\0' || Sequence{pattern}.numbered()) << "path() must get to tell what is wrong";
}

INSTANTIATE_TEST_SUITE_P(
    Table, BadPattern,
    testing::Values(std::pair{"f_%s.pos", "at character 3, found '%s.p'"},
                    std::pair{"f_%n.pos", "at character 3, found '%n.p'"}, std::pair{"%x.pos", "at character 1"},
                    std::pair{"%f.pos", "at character 1"}, std::pair{"%ld.pos", "at character 1"},
                    std::pair{"%*d.pos", "at character 1"}, std::pair{"%-4d.pos", "at character 1"},
                    std::pair{"%.4d.pos", "at character 1"}, std::pair{"%1$d.pos", "at character 1"},
                    std::pair{"a%", "at character 2"}, std::pair{"%99d.pos", "at character 1"},
                    std::pair{"%99999999999999999999d.pos", "at character 1"},
                    std::pair{"%d_%d.pos", "expected one frame number, found a second at character 4"},
                    std::pair{"##_##.pos", "found a second at character 4"},
                    std::pair{"%d_##.pos", "found a second at character 4"},
                    std::pair{"100% water.pos", "at character 4, found '% wa'"},
                    std::pair{"#########################.pos", "at most 20 '#'"}, std::pair{"", "pattern is empty"}));

TEST(Sequence, AgreesWithPrintf) {
    EXPECT_TRUE(rc::check("printf", [](std::int64_t frame) {
        const int width = *rc::gen::inRange(1, 20);
        std::array<char, 64> expected{};
        const int length = *rc::gen::arbitrary<bool>()
                               ? std::snprintf(expected.data(), expected.size(), "%0*" PRId64, width, frame)
                               : -std::snprintf(expected.data(), expected.size(), "%*" PRId64, width, frame);
        const std::string pattern = (length > 0 ? "%0" : "%") + std::to_string(width) + "d";
        RC_ASSERT(pathOf(pattern, frame) == expected.data());
    }));
}

}  // namespace
}  // namespace sluice::particles::test
