// SPDX-License-Identifier: MIT
// Something that fluid stays out of, as a signed distance. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstdint>

#include "simulation/vector.hpp"

namespace sluice::vk {

using Triple = std::array<float, 3>;

enum class SolidKind : std::uint32_t { Plane = 0, Sphere = 1, Capsule = 2, Box = 3 };

/// Something that fluid stays out of. Make it with the functions below.
struct Solid {
    SolidKind kind = SolidKind::Sphere;
    Triple a{};                             ///< plane: unit normal; others: centre or first end
    Triple b{};                             ///< capsule: second end; box: half extents
    float radius = 0.0F;                    ///< sphere, capsule; plane: offset along the normal
    std::array<float, 4> turn{0, 0, 0, 1};  ///< box: unit quaternion from its axes to the world's
};
/// Everything below dot(normal, x) = offset; the normal need not be unit, but not 0.
[[nodiscard]] Solid planeSolid(const Triple& normal, const Triple& through);
[[nodiscard]] Solid sphereSolid(const Triple& centre, float radius);
[[nodiscard]] Solid capsuleSolid(const Triple& a, const Triple& b, float radius);
/// Turned about +y by `degrees`, as host::Crate is.
[[nodiscard]] Solid boxSolid(const Triple& centre, const Triple& half, float degrees_about_y = 0.0F);

/// The nearest place of a solid's surface as x sees it.
struct SolidContact {
    Vector normal{};        ///< unit, out of the solid
    double distance = 0.0;  ///< m; negative inside
};
[[nodiscard]] SolidContact contactWith(const Solid& solid, const Vector& x);

/// Distance from x to the solid's surface, metres; negative inside.
[[nodiscard]] double distanceTo(const Solid& solid, const Triple& x);

}  // namespace sluice::vk
