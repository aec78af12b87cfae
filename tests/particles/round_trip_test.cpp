// SPDX-License-Identifier: MIT
// Property: what the encoder writes, the parser reads back, bit for bit.
#include <rapidcheck.h>

#include <cmath>

#include "builder.hpp"
#include "encode.hpp"
#include "files.hpp"

namespace sluice::particles::test {
namespace {

float usable(float value) {
    return std::isfinite(value) && std::abs(value) <= kMaxCoordinate ? value : 0.5F;
}

std::vector<float> arbitraryValues(std::size_t count) {
    auto values = *rc::gen::container<std::vector<float>>(
        count, rc::gen::oneOf(rc::gen::map(rc::gen::arbitrary<float>(), usable),
                              rc::gen::map(rc::gen::arbitrary<std::uint32_t>(),
                                           [](std::uint32_t bits) { return usable(std::bit_cast<float>(bits)); })));
    return values;
}

ParticleSet arbitrarySet(bool with_radius) {
    ParticleSet set;
    const std::size_t size = 3 * *rc::gen::inRange<std::size_t>(0, 60);
    set.position = arbitraryValues(size);
    if (*rc::gen::arbitrary<bool>()) {
        set.velocity = arbitraryValues(size);
    }
    if (*rc::gen::arbitrary<bool>()) {
        set.colour = *rc::gen::container<std::vector<float>>(
            size,
            rc::gen::map(rc::gen::inRange(0, 1 << 24), [](int n) { return static_cast<float>(n) / 16777216.0F; }));
    }
    if (with_radius || *rc::gen::arbitrary<bool>()) {
        set.radius =
            *rc::gen::map(rc::gen::inRange(1, 1 << 30), [](int n) { return static_cast<float>(n) * 9e-7F + 1e-6F; });
    }
    return set;
}

void checkRoundTrip(Format format, Parser parse, bool whole) {
    const ParticleSet set = arbitrarySet(!whole);
    const Result<std::vector<std::byte>> bytes = encode(set, format, "set");
    RC_ASSERT(bytes.ok());
    const Result<ParticleSet> back = parse(bytes.value(), "set");
    if (!back) {
        RC_FAIL(back.error().message());
    }
    RC_ASSERT(back.value().radius == set.radius);
    RC_ASSERT(sameBits(back.value().position, set.position));
    RC_ASSERT(sameBits(back.value().velocity, whole ? set.velocity : std::vector<float>{}));
    RC_ASSERT(sameBits(back.value().colour, whole ? set.colour : std::vector<float>{}));
}

TEST(RoundTrip, PosIsBitExactInPositionAndRadius) {
    EXPECT_TRUE(rc::check("pos", [] { checkRoundTrip(Format::pos, parsePos, false); }));
}

TEST(RoundTrip, PlyIsBitExact) {
    EXPECT_TRUE(rc::check("ply", [] { checkRoundTrip(Format::ply, parsePly, true); }));
}

TEST(RoundTrip, BgeoIsBitExact) {
    EXPECT_TRUE(rc::check("bgeo", [] { checkRoundTrip(Format::bgeo, parseBgeo, true); }));
}

TEST(RoundTrip, BgeoGzipIsBitExact) {
    EXPECT_TRUE(rc::check("bgeo.gz", [] { checkRoundTrip(Format::bgeo_gzip, parseBgeo, true); }));
}

TEST(RoundTrip, EveryCutOfAFileIsRefused) {
    EXPECT_TRUE(rc::check("cuts", [] {
        ParticleSet set = arbitrarySet(true);
        if (set.position.empty()) {
            set = ParticleSet{0.1F, {1, 2, 3}, {}, {}};
        }
        const auto& [format, parse] = *rc::gen::elementOf(std::vector<std::pair<Format, Parser>>{
            {Format::pos, parsePos}, {Format::ply, parsePly}, {Format::bgeo_gzip, parseBgeo}});
        std::vector<std::byte> bytes = encode(set, format, "set").value();
        bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size()));
        const Result<ParticleSet> back = parse(bytes, "cut");
        RC_ASSERT(!back.ok());
        RC_ASSERT(back.error().code == SLUICE_ERROR_INVALID_ARGUMENT);
    }));
}

TEST(Encode, SetsThatNoFileCanHoldAreRefused) {
    const auto message = [](const ParticleSet& set, Format format) {
        const Result<std::vector<std::byte>> bytes = encode(set, format, "out");
        return bytes ? std::string("accepted") : bytes.error().message();
    };
    EXPECT_EQ(message({0.1F, {1, 2, 3}, {}, {}}, Format::ply), "accepted");
    EXPECT_THAT(message({0.1F, {1, 2}, {}, {}}, Format::ply),
                testing::HasSubstr("out: cannot write 2 position, 0 velocity"));
    EXPECT_THAT(message({0.1F, {1, 2, 3}, {1}, {}}, Format::bgeo), testing::HasSubstr("3 position, 1 velocity"));
    EXPECT_THAT(message({0.0F, {1, 2, 3}, {}, {}}, Format::pos), testing::HasSubstr("cannot write the radius 0 m"));
    EXPECT_THAT(message({-1.0F, {1, 2, 3}, {}, {}}, Format::ply), testing::HasSubstr("cannot write the radius -1 m"));
    EXPECT_THAT(message({0.1F, {1, 2, 3, 4, NAN, 6}, {}, {}}, Format::pos),
                testing::HasSubstr("the position of particle 1: nan"));
    EXPECT_THAT(message({0.1F, {1, 2, 3}, {0, 0, INFINITY}, {}}, Format::bgeo),
                testing::HasSubstr("the velocity of particle 0: inf"));
}

}  // namespace
}  // namespace sluice::particles::test
