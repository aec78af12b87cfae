// SPDX-License-Identifier: MIT
// Tiles: the courtyard's paving and the pool's mosaic.
#include "engine/paint.hpp"

namespace sluice::host {
namespace {

constexpr Vec3 kGrout{0.52F, 0.48F, 0.42F};
constexpr Vec3 kCream{0.87F, 0.81F, 0.69F};
constexpr Vec3 kSand{0.80F, 0.70F, 0.55F};
constexpr Vec3 kTerracotta{0.70F, 0.36F, 0.23F};
constexpr Vec3 kSlate{0.23F, 0.31F, 0.40F};
constexpr Vec3 kNavy{0.08F, 0.19F, 0.40F};
constexpr Vec3 kCobalt{0.13F, 0.38F, 0.64F};
constexpr Vec3 kAqua{0.34F, 0.66F, 0.76F};
constexpr Vec3 kTeal{0.20F, 0.54F, 0.64F};
constexpr Vec3 kWhite{0.93F, 0.93F, 0.88F};
constexpr Vec3 kGold{0.88F, 0.68F, 0.30F};

constexpr float kRootHalf = 0.70710678F;

/// Distance of a point in two overlapping squares, one turned by 45 degrees; < r inside the eight-pointed star of size
/// r.
float starDistance(float x, float y) {
    const float square = std::max(std::abs(x), std::abs(y));
    const float diamond = (std::abs(x) + std::abs(y)) * kRootHalf;
    return std::min(square, diamond);
}

float octagonDistance(float x, float y) {
    const float square = std::max(std::abs(x), std::abs(y));
    const float diamond = (std::abs(x) + std::abs(y)) * kRootHalf;
    return std::max(square, diamond);
}

Vec3 blues(float pick) {
    if (pick < 0.34F) {
        return kAqua;
    }
    if (pick < 0.62F) {
        return kTeal;
    }
    return pick < 0.93F ? mix(kAqua, kCobalt, 0.45F) : kWhite;
}

/// Pale, so that it is still seen through half a metre of water.
Vec3 paleBlues(float pick) {
    if (pick < 0.40F) {
        return mix(kAqua, kWhite, 0.55F);
    }
    if (pick < 0.62F) {
        return kAqua;
    }
    return pick < 0.70F ? kTeal : kWhite;
}

/// The pool floor's design at p in [-1,1]^2, before it is cut into tesserae.
Vec3 medallion(float x, float y, float pick) {
    const float edge = std::max(std::abs(x), std::abs(y));
    const float along = std::abs(x) > std::abs(y) ? y : x;
    if (edge > 0.95F) {
        return kNavy;
    }
    if (edge > 0.83F) {
        const float tooth = std::abs(std::fmod(along * 8.0F + 32.0F, 1.0F) - 0.5F) * 2.0F;
        return (edge - 0.83F) / 0.12F > tooth ? kWhite : kCobalt;
    }
    if (edge > 0.79F) {
        return kGold;
    }
    if (edge > 0.75F) {
        return kNavy;
    }
    const float star = starDistance(x, y);
    const float radius = std::hypot(x, y);
    if (radius < 0.10F) {
        return kGold;
    }
    if (starDistance(x * kRootHalf + y * kRootHalf * 0.6F, y * kRootHalf - x * kRootHalf * 0.6F) < 0.15F) {
        return kTerracotta;
    }
    if (octagonDistance(x, y) < 0.34F) {
        return pick < 0.8F ? kWhite : kCream;
    }
    if (star < 0.40F) {
        return pick < 0.85F ? kCobalt : kNavy;
    }
    if (star < 0.45F) {
        return kGold;
    }
    if (star < 0.49F) {
        return kNavy;
    }
    const float lattice = std::min(std::abs(std::fmod(x + y + 8.0F, 0.375F) - 0.1875F),
                                   std::abs(std::fmod(x - y + 8.0F, 0.375F) - 0.1875F));
    return lattice < 0.024F ? kTeal : paleBlues(pick);
}

/// Cuts a design into square stones with grout between; each stone has its own lightness.
template <typename Design>
Vec3 tesserae(float u, float v, int count, const NoiseField& noise, std::uint32_t salt, const Design& design) {
    const float x = u * static_cast<float>(count);
    const float y = v * static_cast<float>(count);
    const int xi = static_cast<int>(x);
    const int yi = static_cast<int>(y);
    const float dx = std::abs(x - static_cast<float>(xi) - 0.5F);
    const float dy = std::abs(y - static_cast<float>(yi) - 0.5F);
    const Vec3 stone = design((static_cast<float>(xi) + 0.5F) / static_cast<float>(count),
                              (static_cast<float>(yi) + 0.5F) / static_cast<float>(count), hashUnit(xi, yi, salt));
    const float light = 0.86F + 0.22F * hashUnit(xi, yi, salt + 1) + 0.10F * (noise.at(u * 3.0F, v * 3.0F) - 0.5F);
    return mix(stone * light, kGrout * 1.15F, smoothStep(0.39F, 0.46F, std::max(dx, dy)));
}

}  // namespace

Image paintPaving(const NoiseField& noise) {
    constexpr int kTiles = 4;  // per period, so 0.5 m each
    return paintImage(1024, 1024, [&](float u, float v) {
        const float x = u * kTiles;
        const float y = v * kTiles;
        const int xi = static_cast<int>(x);
        const int yi = static_cast<int>(y);
        const float cx = x - static_cast<float>(xi) - 0.5F;
        const float cy = y - static_cast<float>(yi) - 0.5F;
        const float grain = noise.at(u * 4.0F, v * 4.0F) - 0.5F;
        const float vein = 1.0F - std::abs(noise.at(u * 2.0F + 0.3F, v * 2.0F) - 0.5F) * 9.0F;

        // Octagons whose cut corners leave a diamond at every lattice point.
        const float corner = (0.5F - std::abs(cx)) + (0.5F - std::abs(cy));
        const float octagon = std::min({0.5F - std::abs(cx), 0.5F - std::abs(cy), (corner - 0.22F) * kRootHalf});
        const float diamond = (0.22F - corner) * kRootHalf;
        if (diamond > octagon) {
            const int px = static_cast<int>(std::lround(x)) % kTiles;
            const int py = static_cast<int>(std::lround(y)) % kTiles;
            const Vec3 inset = ((px + py) % 2 == 0 ? kTerracotta : kSlate) * (0.92F + 0.2F * hashUnit(px, py, 7));
            return mix(kGrout, inset * (1.0F + 0.25F * grain), smoothStep(0.012F, 0.024F, diamond));
        }
        const float own = hashUnit(xi, yi, 11);
        Vec3 tile = mix(kCream, kSand, 0.75F * own) * (0.94F + 0.10F * hashUnit(xi, yi, 12));
        tile = tile * (1.0F + 0.22F * grain);
        tile = mix(tile, tile * 0.86F, std::clamp(vein, 0.0F, 1.0F) * 0.5F);
        if (xi % 2 == 0 && yi % 2 == 0) {
            // A rosette on every fourth octagon: star, ring and heart.
            const float star = starDistance(cx, cy);
            const float ring = std::hypot(cx, cy);
            tile = mix(kTerracotta * (0.95F + 0.3F * grain), tile, smoothStep(0.175F, 0.183F, star));
            tile = mix(kCream * (0.98F + 0.2F * grain), tile, smoothStep(0.138F, 0.146F, star));
            tile = mix(kSlate * (1.0F + 0.3F * grain), tile, smoothStep(0.095F, 0.103F, ring));
            tile = mix(kGold * (0.95F + 0.3F * grain), tile, smoothStep(0.048F, 0.056F, ring));
        } else {
            const float line = std::abs(octagon - 0.075F);
            tile = mix(kSlate * 1.15F, tile, smoothStep(0.008F, 0.016F, line));
        }
        return mix(kGrout, tile, smoothStep(0.010F, 0.022F, octagon));
    });
}

Image paintPoolFloor(const NoiseField& noise) {
    return paintImage(1024, 1024, [&](float u, float v) {
        return tesserae(u, v, 64, noise, 21,
                        [](float x, float y, float pick) { return medallion(x * 2.0F - 1.0F, y * 2.0F - 1.0F, pick); });
    });
}

Image paintPoolWall(const NoiseField& noise) {
    return paintImage(512, 512, [&](float u, float v) {
        return tesserae(u, v, 26, noise, 31, [](float x, float y, float pick) -> Vec3 {
            if (y > 0.94F || (y > 0.64F && y < 0.68F)) {
                return kNavy;
            }
            if (y > 0.68F) {
                const float wave = 0.81F + 0.08F * std::sin(x * 12.566371F);
                return std::abs(y - wave) < 0.035F ? kGold : kWhite;
            }
            return blues(pick * 0.99F);
        });
    });
}

}  // namespace sluice::host
