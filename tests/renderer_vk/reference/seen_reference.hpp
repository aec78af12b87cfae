// SPDX-License-Identifier: MIT
// A depth field in double precision, from the rule of docs/simulation.md: surfaces and rays in the world, with no code
// of the solver's.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "reference/simulation_terms.hpp"

namespace sluice::vk::test::reference {

/// Where the pinhole of an image is, and what its texels look at.
class Seer {
  public:
    explicit Seer(const DepthField& field) : field_(field) {
        const auto& v = field.camera.view;
        for (std::size_t i = 0; i < 3; ++i) {
            right_[i] = double{v[4 * i]};
            up_[i] = double{v[4 * i + 1]};
            back_[i] = double{v[4 * i + 2]};
        }
        eye_ = -1.0 * (double{v[12]} * right_ + double{v[13]} * up_ + double{v[14]} * back_);
    }

    /// The way from the eye that comes one metre nearer to what it looks at, through a place of the image in texels.
    [[nodiscard]] Vec way(double x, double y) const {
        const auto& p = field_.camera.projection;
        const double s = -double{p[11]};
        const double right = ((2.0 * x / double{field_.view_size[0]} - 1.0) * s + double{p[8]}) / double{p[0]};
        const double up = ((2.0 * y / double{field_.view_size[1]} - 1.0) * s + double{p[9]}) / double{p[5]};
        return right * right_ + up * up_ - back_;
    }
    [[nodiscard]] double depthOf(const Vec& x) const { return -1.0 * dot(x - eye_, back_); }
    /// In texels; none outside of the view.
    [[nodiscard]] std::optional<std::array<double, 2>> place(const Vec& x) const {
        const double depth = depthOf(x);
        if (depth < double{field_.camera.near_plane}) {
            return std::nullopt;
        }
        const auto& p = field_.camera.projection;
        const double s = -double{p[11]} * depth;
        const double right = (double{p[0]} * dot(x - eye_, right_) - double{p[8]} * depth) / s;
        const double up = (double{p[5]} * dot(x - eye_, up_) - double{p[9]} * depth) / s;
        const std::array<double, 2> found{(right + 1.0) / 2.0 * double{field_.view_size[0]},
                                          (up + 1.0) / 2.0 * double{field_.view_size[1]}};
        const bool inside = found[0] >= 0.0 && found[1] >= 0.0 && found[0] < double{field_.view_size[0]} &&
                            found[1] < double{field_.view_size[1]};
        return inside ? std::optional(found) : std::nullopt;
    }
    [[nodiscard]] std::optional<Vec> surface(long x, long y) const {
        if (x < 0 || y < 0 || x >= static_cast<long>(field_.width) || y >= static_cast<long>(field_.height)) {
            return std::nullopt;
        }
        const auto depth =
            double{field_.depth[static_cast<std::size_t>(y) * field_.width + static_cast<std::size_t>(x)]};
        if (!std::isfinite(depth) || depth < double{field_.camera.near_plane} / 2.0 || depth > 1e29) {
            return std::nullopt;
        }
        return eye_ + depth * way(static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5);
    }
    [[nodiscard]] const Vec& eye() const { return eye_; }
    [[nodiscard]] const DepthField& field() const { return field_; }

  private:
    const DepthField& field_;
    Vec eye_{}, right_{}, up_{}, back_{};
};

/// The direction in which the surface goes on from a texel, along one axis of the image: where 1 / depth, which is
/// linear on a plane, bends least.
inline std::optional<Vec> goesOn(const Seer& seer, long x, long y, long dx, long dy) {
    const Vec here = *seer.surface(x, y);
    const auto nearness = [&](long steps) {
        const auto there = seer.surface(x + steps * dx, y + steps * dy);
        return there ? std::optional(1.0 / seer.depthOf(*there)) : std::nullopt;
    };
    struct Side {
        long sign;
        double change, bend;
    };
    std::vector<Side> sides;
    for (const long sign : {-1L, 1L}) {
        if (const auto first = nearness(sign)) {
            const auto second = nearness(2 * sign);
            sides.push_back({sign, std::abs(*first - *nearness(0)),
                             second ? std::abs(2.0 * *first - *second - *nearness(0)) : 1e9});
        }
    }
    if (sides.empty()) {
        return std::nullopt;
    }
    const auto least = [&](double Side::*what) {
        return *std::min_element(sides.begin(), sides.end(),
                                 [&](const Side& a, const Side& b) { return a.*what < b.*what; });
    };
    const bool even = least(&Side::bend).bend < least(&Side::change).change;
    const long sign = even ? least(&Side::bend).sign : least(&Side::change).sign;
    const Vec there = *seer.surface(x + sign * dx, y + sign * dy);
    const auto fx = static_cast<double>(x);
    const auto fy = static_cast<double>(y);
    const double apart = norm(seer.way(fx + static_cast<double>(dx), fy + static_cast<double>(dy)) - seer.way(fx, fy));
    const double steep = std::abs(seer.depthOf(there) - seer.depthOf(here)) / (seer.depthOf(here) * apart);
    return steep <= 32.0 ? std::optional(static_cast<double>(sign) * (there - here)) : std::nullopt;
}

/// The plane of the texel that x lies in.
struct SeenPlane {
    Vec normal{};
    double offset = 0.0;
    double stretch = 1.0;
    double level = 0.0;  ///< of who is a radius away along the view, over the radius
    double reach = 0.0;
    [[nodiscard]] double distance(const Vec& x) const { return stretch * (dot(normal, x) - offset); }
    [[nodiscard]] bool hides(const Vec& x) const { return distance(x) < -reach; }
};

inline std::optional<SeenPlane> planeSeenAt(const DepthField& field, double radius, const Vec& x) {
    const Seer seer(field);
    const auto place = seer.place(x);
    if (!place) {
        return std::nullopt;
    }
    const long column = std::lround(std::floor((*place)[0]));
    const long row = std::lround(std::floor((*place)[1]));
    const auto here = seer.surface(column, row);
    if (!here) {
        return std::nullopt;
    }
    const Vec to_eye = 1.0 / norm(seer.eye() - *here) * (seer.eye() - *here);
    const auto across = goesOn(seer, column, row, 1, 0);
    const auto up = goesOn(seer, column, row, 0, 1);
    Vec normal = to_eye;
    if (across && up) {
        normal = cross(*across, *up);
    } else if (across || up) {
        const Vec along = across ? *across : *up;
        normal = to_eye - dot(to_eye, along) / dot(along, along) * along;
    }
    normal = (dot(normal, to_eye) < 0.0 ? -1.0 : 1.0) / norm(normal) * normal;
    const double facing = std::max(-1.0 * dot(normal, x - seer.eye()) / seer.depthOf(x), 1.0 / 64.0);
    const auto side = [&](long dx, long dy) {
        return norm(*seer.surface(column, row) - seer.eye() -
                    seer.depthOf(*here) *
                        seer.way(static_cast<double>(column + dx) + 0.5, static_cast<double>(row + dy) + 0.5));
    };
    return SeenPlane{normal, dot(normal, *here), std::max(1.0, 1.0 / (4.0 * facing)), std::max(facing, 0.25),
                     std::max({radius, side(1, 0), side(0, 1)})};
}

inline bool hiddenIn(const DepthField& field, double radius, const Vec& x) {
    const auto plane = planeSeenAt(field, radius, x);
    return plane && plane->hides(x);
}

inline std::optional<Contact> touchingSeen(const SimulationSettings& s, const Vec& x) {
    const auto plane = planeSeenAt(*s.seen, double{s.radius}, x);
    return plane && !plane->hides(x) ? std::optional(Contact{plane->normal, plane->distance(x)}) : std::nullopt;
}

inline Vec rescued(const SimulationSettings& s, const Vec& x) {
    const auto plane = s.seen ? planeSeenAt(*s.seen, double{s.radius}, x) : std::nullopt;
    if (!plane || plane->hides(x)) {
        return x;
    }
    const double way = std::max(-plane->distance(x), 0.0) / plane->stretch;
    const Vec to = x + std::min(way, double{s.radius} / 4.0) * plane->normal;
    return hiddenIn(*s.seen, double{s.radius}, to) ? x : to;
}

/// Before the plane of its own texel, or behind it.
inline Vec onItsSide(const SimulationSettings& s, const Vec& x, const Vec& start) {
    const auto r = double{s.radius};
    const auto plane = planeSeenAt(*s.seen, r, x);
    if (!plane) {
        return x;
    }
    const double there = plane->distance(x);
    const double before = plane->distance(start);
    const double goal = plane->hides(start) ? std::min(there, std::max(before, -plane->reach - r / 2.0))
                                            : std::max(there, std::min(r * plane->level, before));
    return x + (goal - there) / plane->stretch * plane->normal;
}

/// x over the plane through the eye and a column's border, or a row's, to the side of a texel's middle.
inline Vec withinTexel(const Seer& seer, const Vec& x, double texel, bool row) {
    const double at = seer.place(x).value()[row ? 1 : 0];
    const double border = at < texel ? texel + 0.01 : texel + 0.99;
    const Vec normal =
        row ? cross(seer.way(0.0, border), seer.way(1.0, border)) : cross(seer.way(border, 0.0), seer.way(border, 1.0));
    return x - dot(normal, x - seer.eye()) / dot(normal, normal) * normal;
}

inline Vec keptInFront(const SimulationSettings& s, const Vec& x, const Vec& start) {
    if (!s.seen) {
        return x;
    }
    const Seer seer(*s.seen);
    const auto r = double{s.radius};
    const auto shut = [&](const Vec& at) {
        const auto plane = planeSeenAt(*s.seen, r, at);
        return plane && plane->hides(at) &&
               -plane->distance(at) < std::max(double{s.seen->thickness}, 2.0 * plane->reach);
    };
    const Vec kept = onItsSide(s, x, start);
    const auto from = seer.place(start);
    if (!from || hiddenIn(*s.seen, r, start) || !shut(kept)) {
        return kept;
    }
    // Along as little of the image's axes as will do.
    const std::array<double, 2> texel{std::floor((*from)[0]), std::floor((*from)[1])};
    const auto place = *seer.place(kept);
    std::optional<Vec> best;
    for (const std::size_t axis : {0U, 1U}) {
        if (std::floor(place.at(axis)) == texel.at(axis)) {
            continue;
        }
        const Vec back = withinTexel(seer, kept, texel.at(axis), axis == 1);
        if (!hiddenIn(*s.seen, r, back) && (!best || norm(back - kept) < norm(*best - kept))) {
            best = back;
        }
    }
    Vec to = best.value_or(kept);
    for (const std::size_t axis : {0U, 1U}) {
        if (!best && std::floor(place.at(axis)) != texel.at(axis)) {
            to = withinTexel(seer, to, texel.at(axis), axis == 1);
        }
    }
    to = onItsSide(s, to, start);
    return shut(to) ? start : to;
}

}  // namespace sluice::vk::test::reference
