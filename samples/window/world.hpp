// SPDX-License-Identifier: MIT
// What stands in the scene: boxes, for the eye, for the fluid and for the mouse. Pure: no OpenGL.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "orbit.hpp"
#include "sluice/sluice.h"

namespace window {

enum class Surface : unsigned char { Stone, Wood, Paint };

struct Box {
    glm::vec3 centre, half;  ///< metres
    float turn = 0.0F;       ///< degrees about +y
    Surface surface = Surface::Stone;
    glm::vec3 colour{1.0F};
    bool solid = true;  ///< to the fluid; what lies outside of its box need not be
};

/// The box that the fluid cannot leave, and the floor's extent. The basin's rim stands around it.
inline constexpr glm::vec3 kLow{-2.0F, 0.0F, -1.5F}, kHigh{2.0F, 2.5F, 1.5F};

[[nodiscard]] std::span<const Box> boxes();
/// The pillar that tests look for.
[[nodiscard]] const Box& redPillar();

/// Those boxes that the fluid meets.
[[nodiscard]] std::vector<SluiceSolid> solids();

/// The first point of a box or of the floor on the ray.
[[nodiscard]] std::optional<glm::vec3> hit(const Ray& ray);

/// The lowest place at or above `place` around which a level disc of that radius touches no solid.
[[nodiscard]] glm::vec3 raised(glm::vec3 place, float radius);

}  // namespace window
