// SPDX-License-Identifier: MIT
// Every pass in double precision, written from the definitions in shaders/ and not from their code paths: all spheres
// are tried at all pixels, kernels are 2-D loops without tiles, and nothing is clipped early.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "pass_rig.hpp"

namespace sluice::vk::test {

using Vec3 = std::array<double, 3>;

/// The frame in double precision.
struct ReferenceFrame {
    explicit ReferenceFrame(const RigScene& scene);

    const RigScene& scene;
    double px, py, ox, oy;  ///< ndc = p * slope - o
    double a, b;            ///< ndc z = a + b / depth
    double focal_x, focal_y;
    double splat_radius;
    std::vector<Vec3> eyes;
    std::vector<std::array<Vec3, 3>> inverses;  ///< of each splat, eye space to a unit sphere about its centre: rows
    std::vector<double> thinnest;               ///< shortest half axis, metres

    /// Nine floats: centre and stretch of a sphere.
    void addSplat(const float* ellipsoid);
    [[nodiscard]] Vec3 ray(double x, double y) const;  ///< through a pixel position, z = -1
    [[nodiscard]] double sceneDepth(std::size_t texel) const;
};

inline constexpr double kEmpty = 1e30;

/// Nearest depth per pixel. `slack`, if given, receives for each pixel the smallest distance in pixels between its
/// centre and a sphere's outline as far as that outline could decide anything: coverage within it is not comparable.
[[nodiscard]] std::vector<double> referenceSplat(const ReferenceFrame& frame, std::vector<double>* slack = nullptr);
/// `share`, if given: what of a sphere counts in a texel where the middle of its chord has that depth and the ray that
/// length.
using ShareOfSphere =
    std::function<double(std::size_t sphere, std::uint32_t x, std::uint32_t y, double middle, double ray)>;
[[nodiscard]] std::vector<double> referenceThickness(const ReferenceFrame& frame, std::uint32_t width,
                                                     std::uint32_t height, const ShareOfSphere& share = {});
/// As many optical depths as texels: what the fluids of the splats absorb of each channel.
[[nodiscard]] std::vector<Vec3> referenceOpticalDepth(const ReferenceFrame& frame, std::uint32_t width,
                                                      std::uint32_t height);
/// The whole filter pass, every iteration and the clean-up.
[[nodiscard]] std::vector<double> referenceFilter(const ReferenceFrame& frame, std::vector<double> depth);
[[nodiscard]] std::vector<Vec3> referenceNormals(const ReferenceFrame& frame, const std::vector<float>& depth);
[[nodiscard]] std::vector<double> referenceBlur(const ReferenceFrame& frame, const std::vector<double>& thickness,
                                                std::uint32_t width, std::uint32_t height,
                                                const std::vector<float>& depth);

}  // namespace sluice::vk::test
