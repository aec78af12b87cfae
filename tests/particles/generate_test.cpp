// SPDX-License-Identifier: MIT
#include "sluice/particles/generate.hpp"

#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "files.hpp"
#include "waves.hpp"

namespace sluice::particles::test {
namespace {

ParticleSet pool(std::size_t count, std::uint64_t seed, double time) {
    Result<ParticleSet> set = generatePool(count, seed, time);
    EXPECT_TRUE(set.ok()) << set.error().message();
    return set ? std::move(set).value() : ParticleSet{};
}

/// FNV-1a over the bits (Fowler, Noll, Vo).
std::uint64_t fingerprint(const ParticleSet& set) {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    for (const auto* values : {&set.position, &set.velocity}) {
        for (const float value : *values) {
            hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x100000001B3ULL;
        }
    }
    return hash ^ std::bit_cast<std::uint32_t>(set.radius);
}

TEST(PlainSine, IsTheSine) {
    double worst = 0.0;
    for (int i = -100'000; i <= 100'000; ++i) {
        const double x = i * 0.00987;
        worst = std::max({worst, std::abs(plainSin(x) - std::sin(x)), std::abs(plainCos(x) - std::cos(x))});
    }
    EXPECT_LT(worst, 1e-12);
}

TEST(Pool, CountAtTimeZeroIsWithinTwoPercentOfTheTarget) {
    for (const std::size_t target : {1000U, 5000U, 20'000U, 100'000U, 333'333U}) {
        const auto count = static_cast<double>(pool(target, 1, 0.0).count());
        EXPECT_NEAR(count, static_cast<double>(target), 0.02 * static_cast<double>(target));
    }
}

TEST(Pool, RadiusIsTheSameAtEveryTimeAndForEverySeed) {
    const float radius = pool(20'000, 1, 0.0).radius;
    EXPECT_EQ(pool(20'000, 1, 0.5).radius, radius);
    EXPECT_EQ(pool(20'000, 9, 3.0).radius, radius);
}

TEST(Pool, SameArgumentsGiveTheRecordedBits) {
    // Recorded with g++ 12 on Debian 12, x86-64. A failure elsewhere means that a compiler or processor computes
    // differently (a fused multiply-add, say), and that sample files are not comparable with those made here.
    EXPECT_EQ(fingerprint(pool(5000, 42, 0.0)), 4175757983172666528ULL);
    EXPECT_EQ(fingerprint(pool(5000, 42, 0.5)), 9342169918067154094ULL);
}

TEST(Pool, TheSeedMovesParticlesAndNothingElse) {
    const ParticleSet a = pool(5000, 1, 0.0);
    const ParticleSet b = pool(5000, 2, 0.0);
    EXPECT_FALSE(sameBits(a.position, b.position));
    EXPECT_NEAR(static_cast<double>(a.count()), static_cast<double>(b.count()), 0.02 * 5000);
}

TEST(Pool, ArgumentsOutOfRangeAreRefused) {
    for (const auto& [count, time] : {std::pair<std::size_t, double>{999, 0.0},
                                      {16'000'001, 0.0},
                                      {5000, -0.1},
                                      {5000, 61.0},
                                      {5000, std::nan("")}}) {
        const Result<ParticleSet> set = generatePool(count, 1, time);
        ASSERT_FALSE(set.ok()) << count << " at " << time;
        EXPECT_EQ(set.error().code, SLUICE_ERROR_INVALID_ARGUMENT);
    }
}

TEST(Pool, TopOfEveryColumnTouchesTheSurface) {
    for (const double time : {0.0, 0.2, 1.7}) {
        const ParticleSet set = pool(20'000, 7, time);
        std::size_t touching = 0;
        for (std::size_t i = 0; i < set.count(); ++i) {
            const auto x = static_cast<double>(set.position[3 * i]);
            const auto y = static_cast<double>(set.position[3 * i + 1]);
            const auto z = static_cast<double>(set.position[3 * i + 2]);
            if (std::abs(poolHeight(x, z, time) - static_cast<double>(set.radius) - y) < 1e-6) {
                ++touching;
            }
        }
        const auto side = static_cast<std::size_t>(std::floor(1.0 / static_cast<double>(set.radius)));
        EXPECT_GE(touching, side * side) << "time " << time;
        EXPECT_LT(touching, side * side * 11 / 10) << "time " << time;
    }
}

TEST(Pool, NothingOfThePoolRisesAboveTheSurfaceAndAllStaysInTheBasin) {
    for (const double time : {0.0, 0.4, 0.55, 0.8, 1.5}) {
        const ParticleSet set = pool(20'000, 3, time);
        const auto r = static_cast<double>(set.radius);
        const PoolBall ball = poolBall(time);
        for (std::size_t i = 0; i < set.count(); ++i) {
            const std::array<double, 3> p{static_cast<double>(set.position[3 * i]),
                                          static_cast<double>(set.position[3 * i + 1]),
                                          static_cast<double>(set.position[3 * i + 2])};
            ASSERT_LE(std::abs(p[0]), 1.0 + 0.5 * r);
            ASSERT_LE(std::abs(p[2]), 1.0 + 0.5 * r);
            ASSERT_GE(p[1], 0.5 * r);
            if (p[1] > poolHeight(p[0], p[2], time)) {  // of the ball or the crown
                const double dx = p[0] - ball.centre[0];
                const double dy = p[1] - ball.centre[1];
                const double dz = p[2] - ball.centre[2];
                const bool in_ball = dx * dx + dy * dy + dz * dz < ball.radius * ball.radius;
                ASSERT_TRUE(in_ball || time > poolImpactTime()) << "a stray particle above the water at time " << time;
            }
        }
    }
}

TEST(Pool, HeightRateIsTheDerivativeOfTheHeight) {
    EXPECT_TRUE(rc::check("rate", [] {
        const auto uniform = [](double low, double high) {
            return low + (high - low) * static_cast<double>(*rc::gen::inRange(0, 1 << 20)) / (1 << 20);
        };
        const double x = uniform(-1.0, 1.0);
        const double z = uniform(-1.0, 1.0);
        const double t = uniform(0.01, 5.0);
        constexpr double kStep = 1e-5;
        // At the two moments when the ring begins and stops growing the derivative jumps; a step across them means
        // nothing.
        RC_PRE(std::abs(t - poolImpactTime()) > 2 * kStep && std::abs(t - poolImpactTime() - 0.15) > 2 * kStep);
        const double slope = (poolHeight(x, z, t + kStep) - poolHeight(x, z, t - kStep)) / (2 * kStep);
        RC_ASSERT(std::abs(slope - poolHeightRate(x, z, t)) < 1e-6);
    }));
}

TEST(Pool, MeanDepthIsKept) {
    for (const double time : {0.0, 0.7, 2.0}) {
        double sum = 0.0;
        constexpr int kSide = 200;
        for (int i = 0; i < kSide; ++i) {
            for (int k = 0; k < kSide; ++k) {
                const double height = poolHeight(-1.0 + (i + 0.5) * 2 / kSide, -1.0 + (k + 0.5) * 2 / kSide, time);
                ASSERT_GT(height, 0.25);
                ASSERT_LT(height, 0.85);
                sum += height;
            }
        }
        EXPECT_NEAR(sum / (kSide * kSide), 0.55, 0.06);
    }
}

/// Particles above the water at `time`.
std::vector<std::array<double, 4>> airborne(const ParticleSet& set, double time) {
    std::vector<std::array<double, 4>> found;
    for (std::size_t i = 0; i < set.count(); ++i) {
        const std::array<double, 4> p{
            static_cast<double>(set.position[3 * i]), static_cast<double>(set.position[3 * i + 1]),
            static_cast<double>(set.position[3 * i + 2]), static_cast<double>(set.velocity[3 * i + 1])};
        if (p[1] > poolHeight(p[0], p[2], time)) {
            found.push_back(p);
        }
    }
    return found;
}

TEST(Pool, BallFallsFreelyAndIsSwallowed) {
    for (const double time : {0.0, 0.1, 0.3}) {
        const auto flying = airborne(pool(20'000, 5, time), time);
        ASSERT_GT(flying.size(), 500U);
        double y = 0.0;
        for (const auto& p : flying) {
            y += p[1];
            EXPECT_NEAR(p[3], -kGravity * time, 1e-5);
        }
        EXPECT_NEAR(y / static_cast<double>(flying.size()), poolBall(time).centre[1], 0.01);
    }
    // At 0.6 s the ball is far below the surface; what flies is the crown, a fiftieth of the target at most.
    const auto crown = airborne(pool(20'000, 5, 0.6), 0.6);
    EXPECT_GT(crown.size(), 100U);
    EXPECT_LE(crown.size(), 400U);
    EXPECT_TRUE(airborne(pool(20'000, 5, 3.0), 3.0).empty()) << "every drop has fallen back";
}

class PoolMotion : public testing::TestWithParam<double> {};

TEST_P(PoolMotion, VelocitiesAreTheDerivativesOfThePositions) {
    // Particles keep their order in the file while no column gains or loses one and nothing dives; so look, from the
    // time given on, for a moment with the same count just before and just after.
    constexpr double kStep = 5e-5;
    for (int try_number = 0; try_number < 50; ++try_number) {
        const double time = GetParam() + 0.001 * try_number;
        const ParticleSet before = pool(2000, 11, time - kStep);
        const ParticleSet now = pool(2000, 11, time);
        const ParticleSet after = pool(2000, 11, time + kStep);
        if (before.count() != now.count() || after.count() != now.count()) {
            continue;
        }
        for (std::size_t i = 0; i < now.position.size(); ++i) {
            const double moved =
                (static_cast<double>(after.position[i]) - static_cast<double>(before.position[i])) / (2 * kStep);
            // A position of about 1 is rounded to 6e-8; two of them over 1e-4 s make 1.2e-3 m/s.
            ASSERT_NEAR(moved, static_cast<double>(now.velocity[i]), 3e-3) << "value " << i << " at time " << time;
        }
        return;
    }
    FAIL() << "no moment without a change of count";
}

INSTANTIATE_TEST_SUITE_P(Times, PoolMotion, testing::Values(0.05, 0.2, 0.6, 1.5));

}  // namespace
}  // namespace sluice::particles::test
