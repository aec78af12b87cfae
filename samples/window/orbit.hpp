// SPDX-License-Identifier: MIT
// A camera that looks at one point from a distance and turns about it. Pure: no OpenGL.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace window {

struct Orbit {
    glm::vec3 target{0.0F, 0.5F, 0.0F};  ///< metres
    float azimuth = 30.0F;               ///< degrees; 0 looks along -z, growing takes the eye towards +x
    float elevation = 25.0F;             ///< degrees above the horizon
    float distance = 5.5F;               ///< metres
};

/// From `origin` along `direction`, which is of unit length.
struct Ray {
    glm::vec3 origin, direction;
};

inline constexpr float kNear = 0.1F, kFar = 60.0F;

/// Degrees for a pixel of a drag.
inline constexpr float kDegreesAPixel = 0.4F;

/// The camera after a drag of so many pixels, right and down: the scene follows the hand.
[[nodiscard]] Orbit dragged(Orbit orbit, glm::vec2 pixels);
/// After so many clicks of the wheel; forward is nearer.
[[nodiscard]] Orbit zoomed(Orbit orbit, float clicks);

[[nodiscard]] glm::vec3 eyeOf(const Orbit& orbit);
[[nodiscard]] glm::mat4 viewOf(const Orbit& orbit);
[[nodiscard]] glm::mat4 projectionOf(glm::ivec2 size);

/// Through the middle of a pixel, counted from the upper left as the mouse is.
[[nodiscard]] Ray rayThrough(const Orbit& orbit, glm::ivec2 size, glm::ivec2 pixel);
/// Where a point is seen, counted likewise.
[[nodiscard]] glm::vec2 pixelOf(const Orbit& orbit, glm::ivec2 size, glm::vec3 point);

}  // namespace window
