// SPDX-License-Identifier: MIT
// Stone and wood.
#include "engine/paint.hpp"

namespace sluice::host {
namespace {

constexpr Vec3 kMortar{0.58F, 0.51F, 0.42F};
constexpr Vec3 kSandstone{0.82F, 0.70F, 0.53F};
constexpr Vec3 kSandstoneDark{0.70F, 0.56F, 0.40F};
constexpr Vec3 kLimestone{0.88F, 0.84F, 0.76F};
constexpr Vec3 kWood{0.62F, 0.43F, 0.25F};
constexpr Vec3 kWoodDark{0.42F, 0.27F, 0.14F};
constexpr float kTau = 6.2831853F;

/// Coursed blocks: `courses` rows of `blocks` stones, every other row shifted by half a stone.
Vec3 courses(float u, float v, int rows, int blocks, const NoiseField& noise) {
    const float y = v * static_cast<float>(rows);
    const int row = static_cast<int>(y);
    const float x = u * static_cast<float>(blocks) + (row % 2 == 0 ? 0.0F : 0.5F);
    const int column = static_cast<int>(x) % blocks;
    const float aspect = static_cast<float>(rows) / static_cast<float>(blocks);
    const float dx = std::min(x - std::floor(x), std::ceil(x) - x) * aspect;
    const float dy = std::min(y - std::floor(y), std::ceil(y) - y);
    const float grain = noise.at(u * 3.0F, v * 3.0F) - 0.5F;
    const float pits = noise.at(u * 9.0F, v * 9.0F);
    Vec3 stone = mix(kSandstone, kSandstoneDark, 0.7F * hashUnit(column, row, 41));
    stone = stone * (0.95F + 0.12F * hashUnit(column, row, 42) + 0.35F * grain);
    stone = stone * (1.0F - 0.18F * smoothStep(0.60F, 0.75F, pits));
    const float edge = std::min(dx, dy);
    // A lighter arris above the joint's shade reads as a bevel.
    stone = stone * (1.0F + 0.10F * (1.0F - smoothStep(0.05F, 0.11F, edge)));
    return mix(kMortar * (0.85F + 0.3F * grain), stone, smoothStep(0.022F, 0.045F, edge + 0.012F * grain));
}

Vec3 plank(float along, float across, float own, const NoiseField& noise) {
    const float bend = noise.at(along * 0.7F + own, across * 0.6F) * 0.6F;
    const float rings = 0.5F + 0.5F * std::sin((across * 5.0F + bend * 3.0F + own * 9.0F) * kTau);
    const float fibre = noise.at(along * 1.0F + own * 3.0F, across * 14.0F);
    const Vec3 base = mix(kWood, kWoodDark, 0.25F + 0.35F * rings * fibre);
    return base * (0.86F + 0.28F * own + 0.30F * (fibre - 0.5F));
}

}  // namespace

Image paintAshlar(const NoiseField& noise) {
    return paintImage(512, 512, [&](float u, float v) { return courses(u, v, 4, 2, noise); });
}

Image paintLimestone(const NoiseField& noise) {
    return paintImage(256, 256, [&](float u, float v) {
        const float cloud = noise.at(u, v) - 0.5F;
        const float grain = noise.at(u * 5.0F, v * 5.0F) - 0.5F;
        const float vein = std::clamp(1.0F - std::abs(noise.at(u + 0.4F, v * 2.0F) - 0.5F) * 14.0F, 0.0F, 1.0F);
        return mix(kLimestone * (1.0F + 0.20F * cloud + 0.14F * grain), kSandstoneDark, 0.22F * vein);
    });
}

Image paintShaft(const NoiseField& noise) {
    constexpr float kFlutes = 4.0F;  // in one period; kShaftTurns periods go around
    return paintImage(256, 256, [&](float u, float v) {
        const float f = u * kFlutes;
        const float hollow = std::abs(f - std::floor(f) - 0.5F) * 2.0F;  // 0 in the hollow, 1 on the arris
        const float grain = noise.at(u, v) - 0.5F + 0.5F * (noise.at(u * 4.0F, v * 4.0F) - 0.5F);
        const float shade = 0.74F + 0.26F * smoothStep(0.10F, 0.95F, hollow);
        return kLimestone * (shade * (1.0F + 0.26F * grain));
    });
}

Image paintArcade(const NoiseField& noise) {
    return paintImage(512, 512, [&](float u, float v) {
        const float x = (u - 0.5F) * 2.0F;  // [-1,1] across 3 m
        const float y = v * 2.0F;           // [0,2] up the wall
        Vec3 wall = courses(u, v, 10, 4, noise);
        if (v > 0.90F) {
            // Cornice: two mouldings and the shadow under them.
            const float step = v > 0.955F ? 1.10F : 0.98F;
            return kLimestone * (step * (0.92F + 0.3F * (noise.at(u * 3.0F, v * 3.0F) - 0.5F)));
        }
        wall = wall * (0.72F + 0.28F * smoothStep(0.90F, 0.84F, v));
        if (v < 0.11F) {
            return kLimestone * (0.80F + 0.3F * (noise.at(u * 3.0F, v * 3.0F) - 0.5F) - (v > 0.10F ? 0.2F : 0.0F));
        }
        constexpr float kSpring = 0.95F;  // where the arch begins to turn
        constexpr float kHalf = 0.62F;
        const float reach = y > kSpring ? std::hypot(x, y - kSpring) : std::abs(x);
        if (reach < kHalf) {
            // The recess is in its own shade, deepest under the arch.
            const float depth = smoothStep(kHalf, kHalf - 0.16F, reach);
            const Vec3 plaster = Vec3{0.76F, 0.47F, 0.33F} * (0.90F + 0.5F * (noise.at(u * 2.0F, v * 2.0F) - 0.5F));
            return plaster * (0.48F + 0.42F * depth * (1.0F - 0.25F * v));
        }
        if (reach < kHalf + 0.13F) {
            // Voussoirs around the arch, jambs below.
            const float angle = std::atan2(y - kSpring, x);
            const float stones = y > kSpring ? angle * 4.138F : (y - kSpring) * 5.0F;
            const float joint = std::abs(stones - std::round(stones));
            const float grain = noise.at(u * 4.0F, v * 4.0F) - 0.5F;
            const float seam = std::min(smoothStep(0.02F, 0.07F, joint), smoothStep(0.13F, 0.12F, reach - kHalf));
            return mix(kMortar * 0.85F, kLimestone * (0.96F + 0.3F * grain), seam);
        }
        return wall;
    });
}

Image paintCrate(const NoiseField& noise) {
    return paintImage(512, 512, [&](float u, float v) {
        constexpr float kFrame = 0.13F;
        constexpr int kPlanks = 5;
        const float edge_u = std::min(u, 1.0F - u);
        const float edge_v = std::min(v, 1.0F - v);
        // Nails at the frame's corners.
        const float nail = std::hypot(edge_u - kFrame * 0.5F, edge_v - kFrame * 0.5F);
        if (nail < 0.016F) {
            return Vec3{0.24F, 0.22F, 0.21F} * (nail < 0.008F ? 1.7F : 1.0F);
        }
        if (edge_v < kFrame) {
            return plank(u, v, 0.3F, noise) * (1.08F - 0.35F * smoothStep(kFrame - 0.012F, kFrame, edge_v));
        }
        if (edge_u < kFrame) {
            return plank(v, u, 0.6F, noise) * (1.05F - 0.35F * smoothStep(kFrame - 0.012F, kFrame, edge_u));
        }
        const float brace = std::abs(u - v) * 0.70710678F;
        if (brace < 0.065F) {
            return plank((u + v) * 0.7F, u - v, 0.8F, noise) * (1.06F - 0.35F * smoothStep(0.053F, 0.065F, brace));
        }
        const float x = u * kPlanks;
        const float gap = std::min(x - std::floor(x), std::ceil(x) - x);
        // Planks lie behind frame and brace, in their shade.
        const float shade = std::min(smoothStep(0.0F, 0.05F, std::min(edge_u, edge_v) - kFrame),
                                     smoothStep(0.0F, 0.05F, brace - 0.065F));
        const Vec3 board = plank(v, u, hashUnit(static_cast<int>(x), 0, 51), noise) * 0.85F;
        return mix(kWoodDark * 0.35F, board * (0.62F + 0.38F * shade), smoothStep(0.015F, 0.05F, gap));
    });
}

}  // namespace sluice::host
