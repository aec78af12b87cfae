// SPDX-License-Identifier: MIT
#include <limits>

#include "files.hpp"

namespace sluice::particles::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

class MalformedPos : public testing::TestWithParam<Malformed> {};

TEST_P(MalformedPos, IsRefusedWithPlaceExpectedAndFound) {
    expectRefused(parsePos, GetParam());
}

File withTail(File file, std::size_t size) {
    file.resize(file.size() + size);
    return file;
}

INSTANTIATE_TEST_SUITE_P(
    Table, MalformedPos,
    testing::Values(
        Malformed{"Empty", {}, {"at byte 0", "expected a header of 8 bytes", "found a file of 0 bytes", "empty"}},
        Malformed{"SevenBytes", File(7), {"at byte 7", "header of 8 bytes", "found a file of 7 bytes"}},
        Malformed{"Truncated",
                  pos(2, 0.1F, {1, 2, 3, 4, 5}),
                  {"at byte 28", "expected 32 bytes for 2 particles", "found 28 bytes", "cut short"}},
        Malformed{"HeaderOnly", pos(1, 0.1F, {}), {"at byte 8", "expected 20 bytes for 1 particles", "found 8 bytes"}},
        Malformed{"Trailing",
                  withTail(pos(1, 0.1F, {1, 2, 3}), 3),
                  {"at byte 20", "expected 20 bytes", "found 23 bytes", "after the last particle"}},
        Malformed{"AbsurdCount",
                  pos(0xFFFFFFFFU, 0.1F, {1, 2, 3}),
                  {"at byte 0", "at most 268435456 particles", "found 4294967295"}},
        Malformed{
            "OneTooMany", pos(268435457U, 0.1F, {}), {"at byte 0", "at most 268435456 particles", "found 268435457"}},
        Malformed{
            "MostButNoData", pos(268435456U, 0.1F, {}), {"at byte 8", "expected 3221225480 bytes", "found 8 bytes"}},
        Malformed{"RadiusZero", pos(1, 0.0F, {1, 2, 3}), {"at byte 4", "expected a particle radius from", "found 0"}},
        Malformed{"RadiusNegative", pos(1, -0.5F, {1, 2, 3}), {"at byte 4", "particle radius", "found -0.5"}},
        Malformed{"RadiusNan", pos(1, kNan, {1, 2, 3}), {"at byte 4", "particle radius", "found nan"}},
        Malformed{"RadiusInfinite", pos(1, kInf, {1, 2, 3}), {"at byte 4", "particle radius", "found inf"}},
        Malformed{"RadiusAbsurd", pos(1, 1e20F, {1, 2, 3}), {"at byte 4", "to 1000 m", "found 1e+20"}},
        Malformed{"RadiusTiny", pos(1, 1e-30F, {1, 2, 3}), {"at byte 4", "from 1e-06", "found 1e-30"}},
        Malformed{"NanPosition",
                  pos(2, 0.1F, {1, 2, 3, 4, kNan, 6}),
                  {"at byte 20", "the position of particle 1 finite", "found (4, nan, 6)"}},
        Malformed{"InfinitePosition",
                  pos(1, 0.1F, {1, 2, -kInf}),
                  {"at byte 8", "the position of particle 0 finite", "found (1, 2, -inf)"}},
        Malformed{"FarPosition", pos(1, 0.1F, {1, 3e38F, 2}), {"at byte 8", "within ±1e+09", "3e+38"}},
        Malformed{"TextFile", text("x y z\n1 2 3\n"), {"at byte 0", "particles", "found 544809080"}}),
    titleOf);

}  // namespace
}  // namespace sluice::particles::test
