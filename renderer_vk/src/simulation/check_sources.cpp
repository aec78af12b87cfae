// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "simulation/sources.hpp"

namespace sluice::vk {
namespace {

/// Particles of one layer of one emitter: more are not a nozzle.
constexpr double kMostSites = 16'384.0;

Error wrong(const std::string& thing, const std::string& expected, const std::string& found, const char* remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("expected {}, found {}", expected, found), remedy};
}

bool finite(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

std::string shown(const Triple& v) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

bool hasLength(const Triple& v) {
    return std::hypot(double{v[0]}, double{v[1]}, double{v[2]}) > 1e-6;
}

Status checkOpening(const Emitter& e, const std::string& thing, float radius) {
    if (!finite(e.centre)) {
        return wrong(thing + ": centre", "finite numbers", shown(e.centre));
    }
    if (!finite(e.direction) || !hasLength(e.direction)) {
        return wrong(thing + ": direction", "a direction of length > 0", shown(e.direction));
    }
    if (!(e.width > 0.0F && e.height > 0.0F && std::isfinite(e.width) && std::isfinite(e.height)) ||
        (e.disc && e.width != e.height)) {
        return wrong(thing + ": width", e.disc ? "a diameter > 0 as width and as height" : "a width and a height > 0",
                     fmt::format("{} and {}", e.width, e.height));
    }
    const double spacing = 2.0 * double{radius};
    if (std::max(double{e.width} / spacing, 1.0) * std::max(double{e.height} / spacing, 1.0) > kMostSites) {
        return wrong(thing + ": width", fmt::format("an opening for at most {} particles", kMostSites),
                     fmt::format("{} by {} m with particles of radius {}", e.width, e.height, radius),
                     "make it smaller, or the radius of the particles larger");
    }
    return {};
}

Status checkFlow(const Emitter& e, const std::string& thing, std::size_t sites, float radius) {
    if (!(e.speed > 0.0F && e.speed <= 1e4F)) {
        return wrong(thing + ": speed", "a speed in (0, 10000] m/s", fmt::format("{}", e.speed),
                     "give a speed; one that is to be shut has a stop, or is left out");
    }
    const double densest = static_cast<double>(sites) * double{e.speed} / (2.0 * double{radius});
    if (!(e.rate >= 0.0F && double{e.rate} <= densest * (1.0 + 1e-6))) {
        return wrong(thing + ": rate",
                     fmt::format("a rate in [0, {:.6g}] particles per second, which is {} at a time, two radii apart",
                                 densest, sites),
                     fmt::format("{}", e.rate), "give 0 for the densest, or a larger opening, or a higher speed");
    }
    if (!(e.start >= 0.0F && std::isfinite(e.start) && std::isfinite(e.stop) && (e.stop == 0.0F || e.stop > e.start))) {
        return wrong(thing + ": stop", "a start >= 0 and a stop after it, or 0 for none",
                     fmt::format("{} and {}", e.start, e.stop), "give 0 and 0 for one that never stops");
    }
    return {};
}

/// Whoever gave the centre has never seen the point: both are told, and which is which.
Error misplaced(const std::string& thing, const Triple& point, const std::string& where, const Triple& centre,
                const char* remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing,
            fmt::format("a point of its opening, {}, lies {} (centre {})", shown(point), where, shown(centre)), remedy};
}

Status checkSites(const Emitter& e, std::span<const Triple> sites, const std::string& thing, float radius,
                  const Triple& low, const Triple& high, std::span<const Solid> solids, const DistanceGrid* meshes) {
    constexpr const char* kMoveOut = "move its centre out, along its direction, or make the opening smaller";
    for (const Triple& x : sites) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (x[axis] < low[axis] + 0.5F * radius || x[axis] > high[axis] - 0.5F * radius) {
                return misplaced(thing, x,
                                 fmt::format("outside the domain, {} to {}, or within half a radius of its walls",
                                             shown(low), shown(high)),
                                 e.centre,
                                 "move its centre into the box, half a radius and half its width from the walls");
            }
        }
        for (std::size_t k = 0; k < solids.size(); ++k) {
            if (distanceTo(solids[k], x) < 0.5 * double{radius}) {
                return misplaced(thing, x, fmt::format("in solid {} or within half a radius of it", k), e.centre,
                                 kMoveOut);
            }
        }
        if (meshes != nullptr && contactWith(*meshes, wide(x)).distance < 0.5 * double{radius}) {
            return misplaced(thing, x, "in the meshes or within half a radius of them", e.centre, kMoveOut);
        }
    }
    return {};
}

Status checkNumber(const char* what, std::size_t number, std::size_t most) {
    return number <= most ? Status{}
                          : Status{wrong(fmt::format("simulation: {}", what), fmt::format("at most {}", most),
                                         fmt::format("{}", number), "leave some out")};
}

Status checkDrain(const Drain& d, const std::string& thing) {
    if (!finite(d.centre) || !finite(d.half) || *std::min_element(d.half.begin(), d.half.end()) <= 0.0F) {
        return wrong(thing, "a finite centre and half extents > 0", shown(d.centre) + " and " + shown(d.half));
    }
    return {};
}

Status checkField(const ForceField& f, const std::string& thing) {
    if (!finite(f.centre) || !finite(f.axis) || !hasLength(f.axis)) {
        return wrong(thing, "a finite centre and an axis of length > 0", shown(f.centre) + " and " + shown(f.axis));
    }
    if (!(std::abs(f.strength) <= 1e4F) || !(f.radius >= 0.0F && std::isfinite(f.radius))) {
        return wrong(thing, "a strength in [-10000, 10000] m/s^2 and a radius >= 0",
                     fmt::format("{} and {}", f.strength, f.radius));
    }
    return {};
}

}  // namespace

Status checkSources(const SourceSettings& s, float radius, const Triple& low, const Triple& high,
                    std::span<const Solid> solids, const DistanceGrid* meshes) {
    for (const auto& [what, number, most] : {std::tuple{"emitters", s.emitters.size(), kMaxEmitters},
                                             {"drains", s.drains.size(), kMaxDrains},
                                             {"fields", s.fields.size(), kMaxFields}}) {
        if (Status status = checkNumber(what, number, most); !status) {
            return status;
        }
    }
    for (std::size_t i = 0; i < s.emitters.size(); ++i) {
        const std::string thing = fmt::format("simulation: emitter {}", i);
        if (Status status = checkOpening(s.emitters[i], thing, radius); !status) {
            return status;
        }
        const std::vector<Triple> sites = outletSites(s.emitters[i], radius);
        if (Status status = checkFlow(s.emitters[i], thing, sites.size(), radius); !status) {
            return status;
        }
        if (Status status = checkSites(s.emitters[i], sites, thing, radius, low, high, solids, meshes); !status) {
            return status;
        }
    }
    for (std::size_t i = 0; i < s.drains.size(); ++i) {
        if (Status status = checkDrain(s.drains[i], fmt::format("simulation: drain {}", i)); !status) {
            return status;
        }
    }
    for (std::size_t i = 0; i < s.fields.size(); ++i) {
        if (Status status = checkField(s.fields[i], fmt::format("simulation: field {}", i)); !status) {
            return status;
        }
    }
    return {};
}

}  // namespace sluice::vk
