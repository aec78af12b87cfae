// SPDX-License-Identifier: MIT
#include "gzip.hpp"

#include "files.hpp"

namespace sluice::particles::test {
namespace {

TEST(Gzip, LimitGrowsWithTheInputAndEndsAtTheCeiling) {
    constexpr std::uint64_t kCeiling = kMaxParticles * 64;
    EXPECT_EQ(inflateLimit(0), 1U << 20U);
    EXPECT_EQ(inflateLimit(1000), (1U << 20U) + 100'000U);
    EXPECT_EQ(inflateLimit(~std::uint64_t{0}), kCeiling);
    EXPECT_LE(inflateLimit(kCeiling / 100), kCeiling);
}

TEST(Gzip, ExactlyTheLimitMayComeOutAndOneByteMoreMayNot) {
    const File data(300'000, std::byte{7});
    const std::vector<std::byte> packed = deflateGzip(data, "zeros").value();
    const Result<std::vector<std::byte>> fits = inflateGzip(packed, "zeros", data.size());
    ASSERT_TRUE(fits.ok()) << fits.error().message();
    EXPECT_EQ(fits.value(), data);
    EXPECT_FALSE(inflateGzip(packed, "zeros", data.size() - 1).ok());
}

TEST(Gzip, BombIsGivenUpLongBeforeItHasUnfolded) {
    // 64 MiB of zeros pack into 64 KiB. The bound lets through a tenth, and what was held by then is all that was held.
    const File zeros(std::size_t{64} << 20U);
    const std::vector<std::byte> bomb = deflateGzip(zeros, "bomb").value();
    ASSERT_LT(bomb.size(), zeros.size() / 900);
    const std::uint64_t limit = inflateLimit(bomb.size());
    EXPECT_LT(limit, zeros.size() / 8);
    const Result<ParticleSet> set = parseBgeo(bomb, "bomb.bgeo.gz");
    ASSERT_FALSE(set.ok());
    EXPECT_THAT(set.error().message(), testing::HasSubstr("expected at most " + std::to_string(limit) + " bytes"));
}

}  // namespace
}  // namespace sluice::particles::test
