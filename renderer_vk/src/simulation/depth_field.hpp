// SPDX-License-Identifier: MIT
// What a camera sees, as a solid: for scenes that have no shapes to offer. docs/simulation.md has the rule. Pure: no
// Vulkan type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/solid.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Deep behind what is seen water is hidden, and not in it: where nobody says how deep, a radius, so that water that
/// touches the back of even the thinnest wall is left alone.
inline constexpr float kThicknessInRadii = 1.0F;
/// Texels of one image: that of the largest screen that is shared.
inline constexpr std::uint64_t kMostSeenTexels = std::uint64_t{1} << 28U;

/// A rigid view and an OpenGL perspective, column-major.
struct DepthView {
    std::array<float, 16> view{}, projection{};
    float near_plane = 0.0F;  ///< m
};

/// An image of depths with its camera. No texels: nothing is seen.
struct DepthField {
    std::uint32_t width = 0, height = 0;
    std::array<float, 2> view_size{};  ///< of the camera's view in texels, as the last ones may reach out of it
    DepthView camera;
    float thickness = 0.0F;  ///< m, that what is seen is deep for who comes round its edge
    std::vector<float>
        depth;  ///< m along -z, bottom row first; not finite, below half the near plane or above 1e29: nothing is there
};

/// As shaders/simulation/seen.glsl reads it, in front of the depths.
struct DepthHeader {
    std::array<std::array<float, 4>, 3> rows{};
    std::array<float, 4> lens{}, limits{};
    std::array<std::uint32_t, 4> size{};
};
static_assert(sizeof(DepthHeader) == 96, "std430");

/// Refused: a view that stretches or mirrors, a projection that is no perspective, a near plane that is not > 0.
[[nodiscard]] Status checkDepthView(const DepthView& camera);
/// For particles of that radius.
[[nodiscard]] Status checkDepthField(const DepthField& field, float radius);
/// Of a camera that has been checked, and a view of so many pixels of which `scale` times `scale` make a texel.
[[nodiscard]] DepthHeader depthHeader(const DepthView& camera, std::uint32_t width, std::uint32_t height,
                                      std::uint32_t scale, float thickness);
[[nodiscard]] DepthHeader depthHeader(const DepthField& field);
/// From depths of pixels, bottom row first: the least depth of each `scale` times `scale` of them, so that what is thin
/// stays; a plane comes nearer by half a texel's part of it at most. Shaders/capture_depth.comp does the same.
[[nodiscard]] DepthField depthField(const DepthView& camera, std::uint32_t width, std::uint32_t height,
                                    std::uint32_t scale, float thickness, const std::vector<float>& depths);

}  // namespace sluice::vk
