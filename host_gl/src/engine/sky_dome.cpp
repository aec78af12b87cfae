// SPDX-License-Identifier: MIT
#include "engine/sky_dome.hpp"

#include <epoxy/gl.h>

#include <numbers>
#include <vector>

#include "engine/colour.hpp"

namespace sluice::host {
namespace {

constexpr float kTau = 2.0F * std::numbers::pi_v<float>;
constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;
constexpr int kDomeSegments = 48;
constexpr int kDomeRings = 40;
constexpr int kGroundRings = 24;
constexpr int kSunSegments = 96;
constexpr int kSunRings = 56;

Vec3 vec3(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}
float dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 unit(const Vec3& a) {
    return a * (1.0F / std::sqrt(dot(a, a)));
}

float sunOuter() {
    return std::cos(2.5F * kDegree);
}
float sunInner() {
    return std::cos(1.0F * kDegree);
}

Vec3 baseRadiance(const SluiceSky& sky, float up) {
    return up >= 0.0F ? mix(vec3(sky.horizon), vec3(sky.zenith), std::sqrt(up))
                      : mix(vec3(sky.horizon), vec3(sky.ground), std::min(1.0F, -4.0F * up));
}

void vertex(const Vec3& colour, const Vec3& position) {
    glColor3fv(colour.data());
    glVertex3fv(position.data());
}

/// Heights of the rings, from the zenith down.
std::vector<float> ringHeights() {
    std::vector<float> heights;
    for (int i = kDomeRings; i > 0; --i) {
        const float s = static_cast<float>(i) / kDomeRings;
        heights.push_back(s * s);
    }
    // The square root is steepest at the horizon.
    for (const float part : {0.5F, 0.25F, 0.1F, 0.0F}) {
        const float s = part / kDomeRings;
        heights.push_back(s * s);
    }
    for (int i = 1; i <= kGroundRings; ++i) {
        heights.push_back(-0.25F * static_cast<float>(i) / kGroundRings);
    }
    heights.push_back(-0.6F);
    heights.push_back(-1.0F);
    return heights;
}

void emitGradient(const SluiceSky& sky) {
    const std::vector<float> heights = ringHeights();
    for (std::size_t ring = 0; ring + 1 < heights.size(); ++ring) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int segment = 0; segment <= kDomeSegments; ++segment) {
            const float turn = kTau * static_cast<float>(segment) / kDomeSegments;
            for (const float y : {heights[ring], heights[ring + 1]}) {
                const float radius = std::sqrt(std::max(0.0F, 1.0F - y * y));
                vertex(encodeSrgb(baseRadiance(sky, y)), {radius * std::sin(turn), y, radius * std::cos(turn)});
            }
        }
        glEnd();
    }
}

void emitSun(const SluiceSky& sky) {
    const Vec3 to_sun = unit(vec3(sky.to_sun));
    const Vec3 side = unit(cross(std::abs(to_sun[1]) < 0.9F ? Vec3{0.0F, 1.0F, 0.0F} : Vec3{1.0F, 0.0F, 0.0F}, to_sun));
    const Vec3 up = cross(to_sun, side);
    const auto direction = [&](float cosine, int segment) {
        const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine));
        const float turn = kTau * static_cast<float>(segment) / kSunSegments;
        return to_sun * cosine + side * (sine * std::cos(turn)) + up * (sine * std::sin(turn));
    };
    const auto cosineOf = [](int ring) {
        const float u = static_cast<float>(ring) / kSunRings;
        return sunOuter() + (sunInner() - sunOuter()) * u * u;
    };
    const auto skyVertex = [&](const Vec3& d) { vertex(encodeSrgb(skyRadiance(sky, d)), d); };
    for (int ring = 0; ring < kSunRings; ++ring) {
        glBegin(GL_TRIANGLE_STRIP);
        for (int segment = 0; segment <= kSunSegments; ++segment) {
            skyVertex(direction(cosineOf(ring), segment));
            skyVertex(direction(cosineOf(ring + 1), segment));
        }
        glEnd();
    }
    glBegin(GL_TRIANGLE_FAN);
    skyVertex(to_sun);
    for (int segment = 0; segment <= kSunSegments; ++segment) {
        skyVertex(direction(sunInner(), segment));
    }
    glEnd();
}

}  // namespace

Vec3 skyRadiance(const SluiceSky& sky, const Vec3& direction) {
    const float sun = smoothStep(sunOuter(), sunInner(), dot(direction, vec3(sky.to_sun)));
    return baseRadiance(sky, direction[1]) + vec3(sky.sun_radiance) * sun;
}

void emitSkyDome(const SluiceSky& sky) {
    emitGradient(sky);
    if (dot(vec3(sky.to_sun), vec3(sky.to_sun)) > 0.0F) {
        emitSun(sky);
    }
}

}  // namespace sluice::host
