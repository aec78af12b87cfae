// SPDX-License-Identifier: MIT
#include "reference/fluid_reference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sluice::vk::test {
namespace {

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vec3 scaled(const Vec3& a, double s) {
    return {a[0] * s, a[1] * s, a[2] * s};
}
Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec3 unit(const Vec3& a) {
    return scaled(a, 1.0 / std::sqrt(dot(a, a)));
}
double smoothstep(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Depths at which a ray enters and leaves a splat, and the distance of the ray from the centre where the splat is a
/// unit sphere.
struct Hit {
    double enter, leave, distance;
};
Hit hit(const Vec3& eye_ray, const Vec3& eye_centre, const std::array<Vec3, 3>& inverse) {
    const auto unitSpace = [&](const Vec3& v) {
        return Vec3{dot(inverse[0], v), dot(inverse[1], v), dot(inverse[2], v)};
    };
    const Vec3 ray = unitSpace(eye_ray);
    const Vec3 centre = unitSpace(eye_centre);
    const double foot = dot(centre, ray) / dot(ray, ray);
    const Vec3 offset = minus(centre, scaled(ray, foot));
    const double squared = dot(offset, offset);
    const double half = std::sqrt(std::max(1.0 - squared, 0.0) / dot(ray, ray));
    return {foot - half, foot + half, std::sqrt(squared)};
}

struct Kernel {
    double sigma;
    int reach;
};
Kernel kernelOf(const ReferenceFrame& frame, double depth, double focal) {
    const SluiceFluid& fluid = frame.scene.fluid;
    const double cap = fluid.filter_max_pixels;
    const double sigma = std::min(double{fluid.filter_sigma} * double{frame.scene.radius} * focal / depth, cap / 3.0);
    return {sigma, static_cast<int>(std::min(std::ceil(3 * sigma), cap))};
}

/// One narrow-range average over the offsets of `kernel`, which come in mirrored pairs.
struct Offset {
    int x, y;
    double weight;
};
double narrowRange(const ReferenceFrame& frame, const std::vector<double>& depth, int x, int y,
                   const std::vector<Offset>& half) {
    const auto width = static_cast<int>(frame.scene.width);
    const auto height = static_cast<int>(frame.scene.height);
    const double radius = double{frame.scene.radius};
    const double delta = double{frame.scene.fluid.filter_range} * radius;
    const double mu = double{frame.scene.fluid.filter_clamp} * radius;
    const auto at = [&](int u, int v) {
        return u < 0 || v < 0 || u >= width || v >= height ? kEmpty : depth[static_cast<std::size_t>(v * width + u)];
    };
    const double centre = at(x, y);
    double sum = 1 / centre;
    double weights = 1;
    for (const Offset& offset : half) {
        std::array<double, 2> pair{at(x + offset.x, y + offset.y), at(x - offset.x, y - offset.y)};
        if (std::any_of(pair.begin(), pair.end(), [&](double d) { return d > 1e29 || d < centre - delta; })) {
            continue;
        }
        for (double d : pair) {
            sum += offset.weight / (d > centre + delta ? centre + mu : d);
            weights += offset.weight;
        }
    }
    return weights / sum;
}

}  // namespace

ReferenceFrame::ReferenceFrame(const RigScene& s) : scene(s) {
    const float(&p)[16] = s.camera.projection;
    px = double{p[0]};
    py = double{p[5]};
    ox = double{p[8]};
    oy = double{p[9]};
    a = -double{p[10]};
    b = double{p[14]};
    focal_x = px * s.width / 2;
    focal_y = py * s.height / 2;
    splat_radius = double{s.fluid.splat_radius} * double{s.radius};
    for (std::size_t i = 0; i < s.ellipsoids.size(); i += 9) {
        addSplat(&s.ellipsoids[i]);
    }
    for (std::size_t i = 0; s.ellipsoids.empty() && i + 2 < s.positions.size(); i += 3) {
        const std::array<float, 9> sphere{s.positions[i], s.positions[i + 1], s.positions[i + 2], 1, 0, 0, 1, 0, 1};
        addSplat(sphere.data());
    }
}

void ReferenceFrame::addSplat(const float* e) {
    Vec3 eye{};
    std::array<Vec3, 3> turn{};
    for (std::size_t row = 0; row < 3; ++row) {
        eye[row] = double{scene.camera.view[12 + row]};
        for (std::size_t column = 0; column < 3; ++column) {
            turn[row][column] = double{scene.camera.view[column * 4 + row]};
            eye[row] += turn[row][column] * double{e[column]};
        }
    }
    eyes.push_back(eye);
    const std::array<Vec3, 3> m{{{double{e[3]}, double{e[4]}, double{e[5]}},
                                 {double{e[4]}, double{e[6]}, double{e[7]}},
                                 {double{e[5]}, double{e[7]}, double{e[8]}}}};
    std::array<Vec3, 3> inverse{cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const double size = dot(m[0], inverse[0]) * splat_radius;
    double largest = 0.0;
    for (Vec3& row : inverse) {
        largest += dot(row, row) / (size * size);  // at least the square of the largest stretch of the inverse
        row = scaled({dot(row, turn[0]), dot(row, turn[1]), dot(row, turn[2])}, 1.0 / size);
    }
    inverses.push_back(inverse);
    thinnest.push_back(1.0 / std::sqrt(largest));
}

Vec3 ReferenceFrame::ray(double x, double y) const {
    return {(2 * x / scene.width - 1 + ox) / px, (2 * y / scene.height - 1 + oy) / py, -1};
}

double ReferenceFrame::sceneDepth(std::size_t texel) const {
    if (scene.host_depth.empty()) {
        return kEmpty;
    }
    const double raw = double{scene.host_depth[texel]};
    if (scene.encoding == SLUICE_DEPTH_LINEAR) {
        return raw < 1e29 ? raw : kEmpty;
    }
    return raw < 1 ? b / (2 * raw - 1 - a) : kEmpty;
}

std::vector<double> referenceSplat(const ReferenceFrame& frame, std::vector<double>* slack) {
    const RigScene& scene = frame.scene;
    const double near = double{scene.camera.near_plane};
    const double far = double{scene.camera.far_plane};
    std::vector<double> depth(std::size_t{scene.width} * scene.height, kEmpty);
    if (slack != nullptr) {
        slack->assign(depth.size(), 1e9);
    }
    for (std::size_t texel = 0; texel < depth.size(); ++texel) {
        const Vec3 ray =
            frame.ray(static_cast<double>(texel % scene.width) + 0.5, static_cast<double>(texel / scene.width) + 0.5);
        for (std::size_t i = 0; i < frame.eyes.size(); ++i) {
            const Hit h = hit(ray, frame.eyes[i], frame.inverses[i]);
            const double d = std::max(h.enter, near);
            if (slack != nullptr && h.leave > near) {
                const double pixels = std::abs(h.distance - 1.0) * frame.thinnest[i] * frame.focal_y /
                                      std::max(-frame.eyes[i][2], near) / std::sqrt(dot(ray, ray));
                (*slack)[texel] = std::min((*slack)[texel], pixels);
            }
            if (h.distance < 1.0 && d <= h.leave && d <= far) {
                depth[texel] = std::min(depth[texel], d);
            }
        }
    }
    return depth;
}

std::vector<double> referenceThickness(const ReferenceFrame& frame, std::uint32_t width, std::uint32_t height,
                                       const ShareOfSphere& share) {
    const RigScene& scene = frame.scene;
    const double scale = std::round(1.0 / double{scene.fluid.thickness_scale});
    const double radius = double{scene.radius};
    const double weight = 8 * std::pow(radius, 3) / (4.0 / 3.0 * std::numbers::pi * std::pow(frame.splat_radius, 3));
    std::vector<double> result(std::size_t{width} * height, 0.0);
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            const Vec3 ray = frame.ray((x + 0.5) * scale, (y + 0.5) * scale);
            double behind = 0;
            for (double v = y * scale; v < std::min((y + 1) * scale, double{1} * scene.height); ++v) {
                for (double u = x * scale; u < std::min((x + 1) * scale, double{1} * scene.width); ++u) {
                    behind = std::max(behind, frame.sceneDepth(static_cast<std::size_t>(v * scene.width + u)));
                }
            }
            for (std::size_t i = 0; i < frame.eyes.size(); ++i) {
                const Hit h = hit(ray, frame.eyes[i], frame.inverses[i]);
                const double chord = std::min(h.leave, behind) - std::max(h.enter, double{scene.camera.near_plane});
                if (chord > 0.0) {
                    const double length = std::sqrt(dot(ray, ray));
                    const double counts = share ? share(i, x, y, 0.5 * (h.enter + h.leave), length) : 1.0;
                    result[std::size_t{y} * width + x] += weight * chord * length * counts;
                }
            }
        }
    }
    return result;
}

std::vector<Vec3> referenceOpticalDepth(const ReferenceFrame& frame, std::uint32_t width, std::uint32_t height) {
    const RigScene& scene = frame.scene;
    std::vector<Vec3> result(std::size_t{width} * height);
    for (std::size_t k = 0; k < 3; ++k) {
        const auto absorption = [&](std::size_t splat, std::uint32_t /*x*/, std::uint32_t /*y*/, double /*middle*/,
                                    double /*ray*/) {
            const std::uint32_t fluid = scene.fluids[splat];
            return double{fluid == 0 || fluid > scene.absorption.size() ? scene.fluid.absorption[k]
                                                                        : scene.absorption[fluid - 1][k]};
        };
        const std::vector<double> channel = referenceThickness(frame, width, height, absorption);
        for (std::size_t i = 0; i < channel.size(); ++i) {
            result[i][k] = channel[i];
        }
    }
    return result;
}

std::vector<double> referenceFilter(const ReferenceFrame& frame, std::vector<double> depth) {
    const auto width = static_cast<int>(frame.scene.width);
    const auto height = static_cast<int>(frame.scene.height);
    const auto pass = [&](auto offsetsAt) {
        std::vector<double> next(depth.size(), kEmpty);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const auto texel = static_cast<std::size_t>(y * width + x);
                if (depth[texel] < 1e29) {
                    next[texel] = narrowRange(frame, depth, x, y, offsetsAt(depth[texel]));
                }
            }
        }
        depth = std::move(next);
    };
    const auto line = [&](bool along_x) {
        pass([&](double d) {
            const Kernel kernel = kernelOf(frame, d, along_x ? frame.focal_x : frame.focal_y);
            std::vector<Offset> half;
            for (int k = 1; k <= kernel.reach; ++k) {
                half.push_back(
                    {along_x ? k : 0, along_x ? 0 : k, std::exp(-0.5 * k * k / (kernel.sigma * kernel.sigma))});
            }
            return half;
        });
    };
    for (std::uint32_t iteration = 0; iteration < frame.scene.fluid.filter_iterations; ++iteration) {
        line(true);
        line(false);
    }
    pass([&](double d) {
        const double sigma = std::min(4.0 / 3.0, kernelOf(frame, d, std::min(frame.focal_x, frame.focal_y)).sigma);
        const int reach = std::min(4, static_cast<int>(std::ceil(3 * sigma)));
        std::vector<Offset> half;
        for (int y = 0; y <= reach; ++y) {
            for (int x = -reach; x <= reach; ++x) {
                if (y > 0 || x > 0) {
                    half.push_back({x, y, std::exp(-0.5 * (x * x + y * y) / (sigma * sigma))});
                }
            }
        }
        return half;
    });
    return depth;
}

std::vector<Vec3> referenceNormals(const ReferenceFrame& frame, const std::vector<float>& depth) {
    const auto width = static_cast<int>(frame.scene.width);
    const auto height = static_cast<int>(frame.scene.height);
    std::vector<Vec3> result(depth.size(), Vec3{0, 0, 0});
    const auto at = [&](int x, int y) {
        return x < 0 || y < 0 || x >= width || y >= height ? kEmpty
                                                           : double{depth[static_cast<std::size_t>(y * width + x)]};
    };
    const auto point = [&](int x, int y) { return scaled(frame.ray(x + 0.5, y + 0.5), at(x, y)); };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const double d = at(x, y);
            if (d > 1e29) {
                continue;
            }
            const Vec3 p = point(x, y);
            const double bend = 0.5 * std::max(double{frame.scene.radius}, d / std::min(frame.focal_x, frame.focal_y));
            const auto tangent = [&](int sx, int sy) -> Vec3 {
                const double ahead = at(x + sx, y + sy);
                const double behind = at(x - sx, y - sy);
                const Vec3 forward = ahead < 1e29 ? minus(point(x + sx, y + sy), p) : Vec3{0, 0, 0};
                const Vec3 backward = behind < 1e29 ? minus(p, point(x - sx, y - sy)) : Vec3{0, 0, 0};
                if (ahead > 1e29 || behind > 1e29) {
                    return ahead < 1e29 ? forward : backward;
                }
                const Vec3 smaller = std::abs(ahead - d) < std::abs(d - behind) ? forward : backward;
                const double broken = smoothstep(bend, 2 * bend, std::abs(ahead - 2 * d + behind));
                Vec3 mixed{};
                for (std::size_t i = 0; i < 3; ++i) {
                    mixed[i] = (1 - broken) * 0.5 * (forward[i] + backward[i]) + broken * smaller[i];
                }
                return mixed;
            };
            const Vec3 tx = tangent(1, 0);
            const Vec3 ty = tangent(0, 1);
            const Vec3 to_eye = unit(scaled(p, -1));
            const bool has_x = dot(tx, tx) > 0;
            const bool has_y = dot(ty, ty) > 0;
            Vec3 normal = to_eye;
            if (has_x && has_y) {
                normal = unit(cross(tx, ty));
            } else if (has_x || has_y) {
                const Vec3 t = unit(has_x ? tx : ty);
                normal = unit(minus(to_eye, scaled(t, dot(to_eye, t))));
            }
            result[static_cast<std::size_t>(y * width + x)] = normal;
        }
    }
    return result;
}

std::vector<double> referenceBlur(const ReferenceFrame& frame, const std::vector<double>& thickness,
                                  std::uint32_t width, std::uint32_t height, const std::vector<float>& depth) {
    const RigScene& scene = frame.scene;
    const double scale = std::round(1.0 / double{scene.fluid.thickness_scale});
    const int w = static_cast<int>(width);
    const int h = static_cast<int>(height);
    const auto sigmaAt = [&](int x, int y, double focal) {
        double nearest = kEmpty;
        for (int v = -1; v <= 1; ++v) {
            for (int u = -1; u <= 1; ++u) {
                const int cx =
                    std::clamp(static_cast<int>((x + u + 0.5) * scale), 0, static_cast<int>(scene.width) - 1);
                const int cy =
                    std::clamp(static_cast<int>((y + v + 0.5) * scale), 0, static_cast<int>(scene.height) - 1);
                nearest = std::min(
                    nearest, double{depth[static_cast<std::size_t>(cy) * scene.width + static_cast<std::size_t>(cx)]});
            }
        }
        const double world = double{scene.fluid.thickness_blur} * double{scene.radius};
        return nearest > 1e29 ? 0.5 : std::clamp(world * focal / scale / nearest, 0.5, 8.0);
    };
    std::vector<double> sums(thickness.size()), counts(thickness.size()), result(thickness.size());
    const auto blur = [&](bool along_x, auto value, auto count, auto store) {
        for (int y = 0; y < h; ++y) {
            for (int x = 0; x < w; ++x) {
                const double sigma = sigmaAt(x, y, along_x ? frame.focal_x : frame.focal_y);
                const int reach = static_cast<int>(std::min(std::ceil(3 * sigma), 24.0));
                double sum = 0;
                double weights = 0;
                for (int k = -reach; k <= reach; ++k) {
                    const int u = along_x ? x + k : x;
                    const int v = along_x ? y : y + k;
                    if (u >= 0 && v >= 0 && u < w && v < h) {
                        const double weight = std::exp(-0.5 * k * k / (sigma * sigma));
                        sum += weight * value(static_cast<std::size_t>(v * w + u));
                        weights += weight * count(static_cast<std::size_t>(v * w + u));
                    }
                }
                store(static_cast<std::size_t>(y * w + x), sum, weights);
            }
        }
    };
    blur(
        true, [&](std::size_t i) { return thickness[i]; }, [&](std::size_t i) { return thickness[i] > 0 ? 1.0 : 0.0; },
        [&](std::size_t i, double sum, double weights) {
            sums[i] = sum;
            counts[i] = weights;
        });
    blur(
        false, [&](std::size_t i) { return sums[i]; }, [&](std::size_t i) { return counts[i]; },
        [&](std::size_t i, double sum, double weights) { result[i] = weights > 0 ? sum / weights : 0.0; });
    return result;
}

}  // namespace sluice::vk::test
