// SPDX-License-Identifier: MIT
// What a 4x4 matrix of a program says about its camera. Matrices are column-major, as OpenGL has them.
#pragma once

#include <array>
#include <string>

namespace sluice::inject {

using Matrix = std::array<float, 16>;

inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// A perspective projection, in the program's units.
struct Lens {
    double near_plane = 0, far_plane = 0;
    double scale_x = 0, scale_y = 0;  ///< cotangents of half the fields of view
    double shift_x = 0, shift_y = 0;  ///< of an asymmetric frustum
    bool reversed = false;            ///< window depth is 1 at the near plane
};

/// What the program has told OpenGL of its depth.
struct DepthRules {
    bool zero_to_one = false;     ///< glClipControl: a matrix maps depth to [0, 1] and not to [-1, 1]
    bool range_reversed = false;  ///< glDepthRange(1, 0)
    bool greater = false;         ///< glDepthFunc: what is greater is before
    bool operator==(const DepthRules&) const = default;
};

/// A projection with its far plane at infinity is given one: this many times its near plane.
inline constexpr double kFarOfInfinite = 1e5;

enum class Shape {
    Perspective,
    Flat,     ///< affine: orthographic, or no projection at all
    Rejected  ///< neither; `reason` says why
};

/// One matrix taken apart.
struct Reading {
    Shape shape = Shape::Rejected;
    Lens lens;
    Matrix view = kIdentity;   ///< rigid: what stands to the right of the projection, its scale taken out
    double scale = 1;          ///< units of the lens per unit of what the matrix is applied to
    bool pure = false;         ///< the projection alone: nothing stands to its right
    bool transposed = false;   ///< the matrix was written row by row
    bool left_handed = false;  ///< a pure projection that looks along +z, as Direct3D's and Irrlicht's do
    std::string reason;
};

/// Takes projection, projection * view and projection * model-view apart, as long as what stands to the right of the
/// projection is a rotation, a translation and one scale. Near and far follow from the depth row.
/// A reversed depth is taken for one only where `rules` make it likely.
[[nodiscard]] Reading readMatrix(const Matrix& matrix, const DepthRules& rules = {});

/// The same for a shader's matrix, which may have been written row by row (a shader that multiplies from the left).
/// Where both readings are cameras, the one without a scale of its own is meant.
[[nodiscard]] Reading readEitherWay(const Matrix& matrix, const DepthRules& rules = {});
[[nodiscard]] Matrix transposed(const Matrix& matrix);
/// A motion of a left-handed world, as it is with the z of both sides turned round.
[[nodiscard]] Matrix otherHanded(const Matrix& matrix);

/// `matrix` without its scale, if it is a rigid motion with one scale and no mirror; identity and false if not.
struct Rigid {
    bool valid = false;
    Matrix matrix = kIdentity;
    double scale = 1;
};
[[nodiscard]] Rigid rigidPart(const Matrix& matrix);

/// With depth from -1 to 1, or from 0 to 1 as glClipControl has it.
[[nodiscard]] Matrix projectionOf(const Lens& lens, bool zero_to_one = false);
[[nodiscard]] Matrix product(const Matrix& a, const Matrix& b);
[[nodiscard]] bool isIdentity(const Matrix& matrix);
/// Equal but for what rounding leaves in matrices that were multiplied in single precision.
[[nodiscard]] bool sameLens(const Lens& a, const Lens& b);

}  // namespace sluice::inject
