// SPDX-License-Identifier: MIT
#include "tracker/projection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace sluice::inject {

namespace {

struct Row {
    double x, y, z, w;
};

Row row(const Matrix& m, std::size_t i) {
    return {double{m[i]}, double{m[4 + i]}, double{m[8 + i]}, double{m[12 + i]}};
}

double dot(const Row& a, const Row& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

double length(const Row& a) {
    return std::sqrt(dot(a, a));
}

Row combine(double s, const Row& a, double t, const Row& b) {
    return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z, s * a.w + t * b.w};
}

/// Of three rows: positive for a right-handed system.
double determinant(const Row& a, const Row& b, const Row& c) {
    return a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x);
}

/// The first three entries divided by `scale`; a translation is in eye units as it stands.
void putRow(Matrix& m, std::size_t i, const Row& r, double scale) {
    m[i] = static_cast<float>(r.x / scale);
    m[4 + i] = static_cast<float>(r.y / scale);
    m[8 + i] = static_cast<float>(r.z / scale);
    m[12 + i] = static_cast<float>(r.w);
}

Reading rejected(std::string reason) {
    Reading reading;
    reading.reason = std::move(reason);
    return reading;
}

bool finite(const Matrix& m) {
    return std::all_of(m.begin(), m.end(), [](float value) { return std::isfinite(value); });
}

constexpr double kParallel = 2e-3;       // how far a row may lie off its direction, of its length
constexpr double kPerpendicular = 2e-2;  // cosine of the angle between two axes of a view
constexpr double kInfinite = 4e-7;  // single precision cannot tell a far plane beyond 5e6 near planes from infinity
constexpr double kWidest = 0.02, kNarrowest = 100.0;  // cotangents: 178 degrees and 1.1 degrees

/// Near and far of the depth row a * z + b, or why they are none.
std::string readDepth(double a, double b, const DepthRules& rules, Lens& lens) {
    // Upside down, it is the depth row of the same planes.
    const bool upside_down = a > 0.0 && b > 0.0 && (rules.zero_to_one || rules.greater || rules.range_reversed);
    if (upside_down) {
        a = -a;
        b = -b;
    }
    lens.reversed = upside_down != rules.range_reversed;
    lens.near_plane = b / (a - 1.0);
    const bool infinite = std::abs(a + 1.0) < kInfinite;
    lens.far_plane = infinite ? lens.near_plane * kFarOfInfinite : b / (a + 1.0);
    if (!(lens.near_plane > 0.0) || !std::isfinite(lens.near_plane)) {
        return fmt::format("its near plane would lie at {:.3g}", lens.near_plane);
    }
    if (!(lens.far_plane > lens.near_plane) || !std::isfinite(lens.far_plane)) {
        return fmt::format("its far plane would lie at {:.3g}, its near plane at {:.3g}", lens.far_plane,
                           lens.near_plane);
    }
    return {};
}

constexpr Matrix kOtherHand{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1};

}  // namespace

Reading readMatrix(const Matrix& matrix, const DepthRules& rules) {
    if (!finite(matrix)) {
        return rejected("it is not finite");
    }
    const Row x = row(matrix, 0);
    const Row y = row(matrix, 1);
    const Row w = row(matrix, 3);
    const Row written = row(matrix, 2);
    const Row z = rules.zero_to_one
                      ? Row{2 * written.x - w.x, 2 * written.y - w.y, 2 * written.z - w.z, 2 * written.w - w.w}
                      : written;
    const double scale = length(w);
    if (scale < 1e-6 * std::max({length(x), length(y), length(z), std::abs(w.w)})) {
        if (w.w == 0.0) {
            return rejected("its last row is zero");
        }
        Reading flat;
        flat.shape = Shape::Flat;
        return flat;
    }
    if (scale == 0.0) {
        return rejected("it is zero");
    }
    // clip.w = -eye.z, so the last row is the view's third one with its sign turned.
    const Row depth = combine(-1.0, w, 0.0, w);
    const double square = scale * scale;
    Reading reading;
    const double a = dot(z, depth) / square;
    const Row off = combine(1.0, z, -a, depth);
    if (length(off) > kParallel * std::max(length(z), scale)) {
        return rejected("its depth is not that of a projection (an oblique near plane, or no projection)");
    }
    if (std::string why = readDepth(a, off.w, rules, reading.lens); !why.empty()) {
        return rejected(std::move(why));
    }
    reading.lens.shift_x = dot(x, depth) / square;
    reading.lens.shift_y = dot(y, depth) / square;
    const Row across = combine(1.0, x, -reading.lens.shift_x, depth);
    const Row upward = combine(1.0, y, -reading.lens.shift_y, depth);
    reading.lens.scale_x = length(across) / scale;
    reading.lens.scale_y = length(upward) / scale;
    for (const double s : {reading.lens.scale_x, reading.lens.scale_y}) {
        if (!(s > kWidest && s < kNarrowest)) {
            return rejected(fmt::format("its field of view would have the cotangent {:.3g}", s));
        }
    }
    const Row right = combine(1.0 / reading.lens.scale_x, across, 0.0, w);
    const Row up = combine(1.0 / reading.lens.scale_y, upward, 0.0, w);
    if (std::abs(dot(right, up)) > kPerpendicular * square) {
        return rejected("what stands right of the projection is sheared");
    }
    reading.shape = Shape::Perspective;
    reading.scale = scale;
    putRow(reading.view, 0, right, scale);
    putRow(reading.view, 1, up, scale);
    putRow(reading.view, 2, depth, scale);
    if (determinant(right, up, depth) < 0.0) {
        // The pass of a mirror, unless nothing but the projection itself is.
        reading.view = product(reading.view, kOtherHand);
        reading.left_handed = isIdentity(reading.view) && std::abs(scale - 1.0) < 1e-5;
        if (!reading.left_handed) {
            return rejected("it is mirrored");
        }
    }
    reading.pure = isIdentity(reading.view) && std::abs(scale - 1.0) < 1e-5;
    return reading;
}

Matrix transposed(const Matrix& matrix) {
    Matrix out{};
    for (std::size_t i = 0; i < out.size(); ++i) {
        out.at(i) = matrix.at(i % 4 * 4 + i / 4);
    }
    return out;
}

Matrix otherHanded(const Matrix& matrix) {
    return product(kOtherHand, product(matrix, kOtherHand));
}

Reading readEitherWay(const Matrix& matrix, const DepthRules& rules) {
    Reading as_is = readMatrix(matrix, rules);
    const auto scaling = [](const Reading& reading) { return std::abs(std::log(reading.scale)); };
    if (as_is.shape == Shape::Flat || (as_is.shape == Shape::Perspective && scaling(as_is) < 1e-4)) {
        return as_is;
    }
    Reading turned = readMatrix(transposed(matrix), rules);
    turned.transposed = true;
    if (turned.shape != Shape::Perspective) {
        return as_is;
    }
    return as_is.shape == Shape::Perspective && scaling(as_is) <= scaling(turned) ? as_is : turned;
}

Rigid rigidPart(const Matrix& matrix) {
    const Row x = row(matrix, 0);
    const Row y = row(matrix, 1);
    const Row z = row(matrix, 2);
    const double scale = length(x);
    const double square = scale * scale;
    const bool affine = matrix[3] == 0 && matrix[7] == 0 && matrix[11] == 0 && matrix[15] == 1;
    if (!finite(matrix) || !affine || !(scale > 1e-9) || std::abs(length(y) - scale) > kPerpendicular * scale ||
        std::abs(length(z) - scale) > kPerpendicular * scale || std::abs(dot(x, y)) > kPerpendicular * square ||
        std::abs(dot(y, z)) > kPerpendicular * square || std::abs(dot(x, z)) > kPerpendicular * square ||
        determinant(x, y, z) < 0.0) {
        return {};
    }
    Rigid rigid;
    rigid.valid = true;
    rigid.scale = scale;
    putRow(rigid.matrix, 0, x, scale);
    putRow(rigid.matrix, 1, y, scale);
    putRow(rigid.matrix, 2, z, scale);
    return rigid;
}

Matrix projectionOf(const Lens& lens, bool zero_to_one) {
    const double depth = lens.far_plane - lens.near_plane;
    Matrix m{};
    m[0] = static_cast<float>(lens.scale_x);
    m[5] = static_cast<float>(lens.scale_y);
    m[8] = static_cast<float>(lens.shift_x);
    m[9] = static_cast<float>(lens.shift_y);
    m[10] = static_cast<float>(-(lens.far_plane + lens.near_plane) / depth);
    m[11] = -1.0F;
    m[14] = static_cast<float>(-2.0 * lens.far_plane * lens.near_plane / depth);
    if (zero_to_one) {
        m[10] = static_cast<float>(-lens.far_plane / depth);
        m[14] = static_cast<float>(-lens.far_plane * lens.near_plane / depth);
    }
    return m;
}

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t i = 0; i < 4; ++i) {
            double sum = 0.0;
            for (std::size_t k = 0; k < 4; ++k) {
                sum += double{a[4 * k + i]} * double{b[4 * column + k]};
            }
            out[4 * column + i] = static_cast<float>(sum);
        }
    }
    return out;
}

bool isIdentity(const Matrix& matrix) {
    for (std::size_t i = 0; i < matrix.size(); ++i) {
        if (std::abs(matrix[i] - kIdentity[i]) > 1e-5F) {
            return false;
        }
    }
    return true;
}

bool sameLens(const Lens& a, const Lens& b) {
    const auto close = [](double p, double q, double tolerance) {
        return std::abs(p - q) <= tolerance * std::max(std::abs(p), std::abs(q));
    };
    // A far plane hangs on the last bits of the depth row.
    return a.reversed == b.reversed && close(a.near_plane, b.near_plane, 0.02) &&
           close(a.far_plane, b.far_plane, 0.2) && close(a.scale_x, b.scale_x, 0.01) &&
           close(a.scale_y, b.scale_y, 0.01) && std::abs(a.shift_x - b.shift_x) < 0.01 &&
           std::abs(a.shift_y - b.shift_y) < 0.01;
}

}  // namespace sluice::inject
