// SPDX-License-Identifier: MIT
#include "api/camera.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "context/profile.hpp"

namespace sluice::host {

namespace {

/// Stands for an infinite far plane; what the renderer does with the number is to bound its own values.
constexpr double kFarthest = 1e6;
/// What may be left in the last row of a view that was multiplied, or taken out of a product, in 32-bit floats.
constexpr float kFlat = 1e-2F;
/// Likewise in the lengths and angles of its axes; and a scale nearer to 1 than the second is rounding.
constexpr double kUneven = 3e-2;
constexpr double kUnscaled = 1e-3;

Error wrong(std::string detail, const char* remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, "camera", std::move(detail), remedy};
}

Status checkFinite(const char* name, const Matrix& matrix) {
    const auto* const found =
        std::find_if(matrix.begin(), matrix.end(), [](float value) { return !std::isfinite(value); });
    if (found == matrix.end()) {
        return {};
    }
    return wrong(
        fmt::format("element {} of its {} is {}, expected a finite number", found - matrix.begin(), name, *found),
        "look for a division by zero where the matrix is made: an eye at its own target, a look straight along "
        "the up vector, a window of height 0");
}

/// How many units of eye space a metre is: 1 where nobody scales.
Result<double> scaleOf(const Matrix& view) {
    std::array<double, 3> lengths{};
    std::array<double, 3> cosines{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t next = (axis + 1) % 3;
        for (std::size_t row = 0; row < 3; ++row) {
            lengths[axis] += double{view[axis * 4 + row]} * double{view[axis * 4 + row]};
            cosines[axis] += double{view[axis * 4 + row]} * double{view[next * 4 + row]};
        }
        lengths[axis] = std::sqrt(lengths[axis]);
    }
    const auto [least, most] = std::minmax_element(lengths.begin(), lengths.end());
    if (!(*least > 0.0) || *most > (1.0 + kUneven) * *least) {
        return wrong(fmt::format("its view scales the axes x, y and z by {:.6g}, {:.6g} and {:.6g}, expected one scale "
                                 "above 0 for all three",
                                 lengths[0], lengths[1], lengths[2]),
                     "give the world's view without the transform of an object: a rotation, a translation and at most "
                     "one scale, the units of your world that a metre has");
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double cosine = cosines[axis] / (lengths[axis] * lengths[(axis + 1) % 3]);
        if (std::abs(cosine) > kUneven) {
            return wrong(fmt::format("axes {} and {} of its view have an angle of cosine {:.6g}, expected 0",
                                     "xyz"[axis], "xyz"[(axis + 1) % 3], cosine),
                         "give the world's view without the transform of an object: a rotation, a translation and at "
                         "most one scale");
        }
    }
    const double scale = std::cbrt(lengths[0] * lengths[1] * lengths[2]);
    return std::abs(scale - 1.0) > kUnscaled ? scale : 1.0;
}

/// Eye space in metres, as the renderer takes it, from one of `scale` units a metre. The picture and its depths stay as
/// they are: clip space is divided by the scale with its w.
void takeScaleOut(SluiceCamera& camera, double scale) {
    if (scale == 1.0) {
        return;
    }
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            float& value = camera.view[column * 4 + row];
            value = static_cast<float>(double{value} / scale);
        }
    }
    for (std::size_t row = 0; row < 4; ++row) {
        float& value = camera.projection[12 + row];
        value = static_cast<float>(double{value} / scale);
    }
}

/// glDepthRange puts [-1, 1] into [range[0], range[1]] where [0, 1] is what everybody behind here takes for granted:
/// z' = (f - n) z + (f + n - 1) w does the same before the division.
void applyRange(SluiceCamera& camera, const std::array<float, 2>& range) {
    const float scale = range[1] - range[0];
    const float shift = range[1] + range[0] - 1.0F;
    for (std::size_t column = 0; column < 4; ++column) {
        float& z = camera.projection[column * 4 + 2];
        z = scale * z + shift * camera.projection[column * 4 + 3];
    }
}

}  // namespace

Result<SluiceCamera> cameraOf(const Matrix& view, const Matrix& projection, const DepthMapping& depth) {
    for (const auto& [name, matrix] : {std::pair{"view", &view}, std::pair{"projection", &projection}}) {
        if (Status status = checkFinite(name, *matrix); !status) {
            return status.error();
        }
    }
    // A transposed projection is a possible one, with a near of its own; a transposed view is none.
    const std::array row{view[3], view[7], view[11], view[15] - 1.0F};
    if (std::any_of(row.begin(), row.end(), [](float value) { return std::abs(value) > kFlat; })) {
        return wrong(fmt::format("elements 3, 7, 11 and 15 of its view are {}, {}, {} and {}, expected 0, 0, 0 and 1",
                                 view[3], view[7], view[11], view[15]),
                     "give both matrices in column order, as OpenGL has them in memory: transpose them");
    }
    const Result<double> scale = scaleOf(view);
    if (!scale) {
        return scale.error();
    }
    SluiceCamera camera{};
    std::copy(view.begin(), view.end(), camera.view);
    std::copy(projection.begin(), projection.end(), camera.projection);
    takeScaleOut(camera, scale.value());
    if (depth.zero_to_one) {
        // z' = 2 z - w puts [0, w] where OpenGL has [-w, w], so that window depth comes out the same.
        for (std::size_t column = 0; column < 4; ++column) {
            camera.projection[column * 4 + 2] =
                2.0F * camera.projection[column * 4 + 2] - camera.projection[column * 4 + 3];
        }
    }
    const bool whole = depth.range == std::array{0.0F, 1.0F};
    if (!whole) {
        applyRange(camera, depth.range);
    }
    const double p11{camera.projection[11]};
    const double p15{camera.projection[15]};
    if (!(p11 < 0.0) || std::abs(p15) > 1e-6 * std::abs(p11)) {
        return wrong(fmt::format("elements 11 and 15 of its projection are {} and {}, expected -1 and 0 as glFrustum "
                                 "makes them",
                                 p11, p15),
                     "give the perspective projection of the world, not that of a HUD, in column order");
    }
    const double p10 = double{camera.projection[10]} / -p11;
    const double p14 = double{camera.projection[14]} / -p11;
    const double near = p14 / (p10 - 1.0);
    // A quotient below 0 lies beyond infinity: a far plane that was moved there, or that the range leaves no room for.
    const double quotient = p14 / (p10 + 1.0);
    const double far = std::abs(p10 + 1.0) > 1e-12 && quotient > 0.0 ? quotient : kFarthest;
    if (!(near > 0.0) || !(far > near)) {
        return wrong(
            fmt::format("its projection has near {:.6g} and far {:.6g}{}, expected 0 < near < far", near, far,
                        whole ? "" : fmt::format(" through glDepthRange({}, {})", depth.range[0], depth.range[1])),
            "reversed depth, near at 1 and far at 0, is not understood: draw the world with near at 0");
    }
    camera.near_plane = static_cast<float>(near);
    camera.far_plane = static_cast<float>(std::min(far, kFarthest));
    return camera;
}

Result<std::array<Matrix, 2>> matricesOfContext() {
    if (!hasFixedFunction()) {
        return wrong("it is NULL, and a core profile has no matrices of its own", "give view and projection");
    }
    std::array<Matrix, 2> found{};
    glGetFloatv(GL_MODELVIEW_MATRIX, found[0].data());
    glGetFloatv(GL_PROJECTION_MATRIX, found[1].data());
    return found;
}

bool clipsZeroToOne() {
    if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_ARB_clip_control")) {
        return false;
    }
    GLint mode = GL_NEGATIVE_ONE_TO_ONE;
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &mode);
    return mode == GL_ZERO_TO_ONE;
}

std::array<float, 2> depthRange() {
    std::array<float, 2> range{0.0F, 1.0F};
    glGetFloatv(GL_DEPTH_RANGE, range.data());
    return range;
}

Status checkDepthTest() {
    GLint function = GL_LESS;
    float clear = 1.0F;
    glGetIntegerv(GL_DEPTH_FUNC, &function);
    glGetFloatv(GL_DEPTH_CLEAR_VALUE, &clear);
    if ((function != GL_GREATER && function != GL_GEQUAL) || clear != 0.0F || glIsEnabled(GL_DEPTH_TEST) == GL_FALSE) {
        return {};
    }
    return wrong(fmt::format("its near lies at depth 0, but the depth test is {} and glClearDepth 0",
                             function == GL_GREATER ? "GL_GREATER" : "GL_GEQUAL"),
                 "reversed depth is not understood: draw the world with near at 0, GL_LESS and glClearDepth(1)");
}

}  // namespace sluice::host
