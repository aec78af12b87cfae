// SPDX-License-Identifier: MIT
#include "simulation/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "simulation/vector.hpp"

namespace sluice::vk {
namespace {

/// Whether a corner of the domain lies below the plane.
bool planeReaches(const Solid& plane, const SimulationSettings& s, double slack) {
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Triple x{(corner & 1U) != 0 ? s.high[0] : s.low[0], (corner & 2U) != 0 ? s.high[1] : s.low[1],
                       (corner & 4U) != 0 ? s.high[2] : s.low[2]};
        if (distanceTo(plane, x) < -slack) {
            return true;
        }
    }
    return false;
}

/// Whether the box around the solid, along the world's axes, overlaps the domain.
bool boxReaches(const Solid& solid, const SimulationSettings& s, double slack) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto low = double{solid.a[axis]};
        auto high = low;
        if (solid.kind == SolidKind::Capsule) {
            low = std::min(low, double{solid.b[axis]});
            high = std::max(high, double{solid.b[axis]});
        }
        auto reach = double{solid.radius};
        if (solid.kind == SolidKind::Box) {
            Vector along{};
            along[axis] = 1.0;
            along = turnedBack(solid.turn, along);
            reach = 0.0;
            for (std::size_t i = 0; i < 3; ++i) {
                reach += std::abs(along[i]) * double{solid.b[i]};
            }
        }
        if (high + reach <= double{s.low[axis]} + slack || low - reach >= double{s.high[axis]} - slack) {
            return false;
        }
    }
    return true;
}

bool finite(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

Error wrong(const std::string& thing, const std::string& expected, const std::string& found, const char* remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("expected {}, found {}", expected, found), remedy};
}

std::string shown(std::span<const float> v) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

Status checkRange(const char* name, float value, float low, float high) {
    if (!(value >= low && value <= high)) {
        return wrong(fmt::format("simulation: {}", name), fmt::format("a number in [{}, {}]", low, high),
                     fmt::format("{}", value));
    }
    return {};
}

Status checkSolid(const Solid& solid, std::size_t index) {
    const std::string thing = fmt::format("simulation: solid {}", index);
    if (!finite(solid.a) || !finite(solid.b) || !finite(solid.turn) || !std::isfinite(solid.radius)) {
        return wrong(thing, "finite numbers", "NaN or infinity");
    }
    const bool round = solid.kind == SolidKind::Sphere || solid.kind == SolidKind::Capsule;
    if (round && solid.radius <= 0.0F) {
        return wrong(thing, "a radius > 0", fmt::format("{}", solid.radius));
    }
    if (solid.kind == SolidKind::Box && *std::min_element(solid.b.begin(), solid.b.end()) <= 0.0F) {
        return wrong(thing, "half extents > 0", shown(solid.b));
    }
    return {};
}

/// A free body whose centre is in something else is pushed out of it nowhere in particular, or never.
Status checkBodiesApart(const SimulationSettings& s) {
    const auto inside = [&s](std::size_t i, const std::string& what) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("simulation: body {}: centre", i),
                     fmt::format("{} lies in {}", shown(s.bodies[i].centre), what), "move one out of the other"};
    };
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        if (!s.bodies[i].free()) {
            continue;
        }
        for (std::size_t k = 0; k < s.solids.size(); ++k) {
            if (distanceTo(s.solids[k], s.bodies[i].centre) < 0.0) {
                return inside(i, fmt::format("solid {}", k));
            }
        }
        for (std::size_t k = 0; k < s.bodies.size(); ++k) {
            if (k != i && distanceTo(solidOf(s.bodies[k], startOf(s.bodies[k])), s.bodies[i].centre) < 0.0) {
                return inside(i, fmt::format("body {}", k));
            }
        }
    }
    return {};
}

}  // namespace

bool SimulationSettings::tense() const {
    return fluids.empty() ? tension > 0.0F || adhesion > 0.0F
                          : std::any_of(fluids.begin(), fluids.end(), [](const Fluid& fluid) {
                                return fluid.tension > 0.0F || fluid.adhesion > 0.0F;
                            });
}

void apply(const FlowSettings& flow, SimulationSettings& settings) {
    settings.iterations = flow.iterations;
    settings.gravity = flow.gravity;
    settings.viscosity = flow.viscosity;
    settings.vorticity = flow.vorticity;
    settings.tension = flow.tension;
    settings.adhesion = flow.adhesion;
    settings.sources.emitters = flow.emitters;
    if (!flow.fluids.empty()) {
        settings.fluids = flow.fluids;
    }
}

std::vector<Solid> solidsWithin(const SimulationSettings& settings) {
    const double slack = 1e-3 * double{settings.radius};
    std::vector<Solid> within;
    std::copy_if(settings.solids.begin(), settings.solids.end(), std::back_inserter(within), [&](const Solid& solid) {
        return solid.kind == SolidKind::Plane ? planeReaches(solid, settings, slack)
                                              : boxReaches(solid, settings, slack);
    });
    return within;
}

Status checkSettings(const SimulationSettings& s) {
    const struct {
        const char* name;
        float value, low, high;
    } ranges[] = {{"radius", s.radius, 1e-5F, 1e3F},        {"relaxation", s.relaxation, 1e-6F, 1e3F},
                  {"tensile", s.tensile, 0.0F, 1.0F},       {"viscosity", s.viscosity, 0.0F, 1.0F},
                  {"vorticity", s.vorticity, 0.0F, 100.0F}, {"tension", s.tension, 0.0F, 100.0F},
                  {"adhesion", s.adhesion, 0.0F, 100.0F},   {"cfl", s.cfl, 0.01F, 0.5F},
                  {"overshoot", s.overshoot, 0.0F, 1.0F}};
    for (const auto& range : ranges) {
        if (Status status = checkRange(range.name, range.value, range.low, range.high); !status) {
            return status;
        }
    }
    if (s.iterations < 1 || s.iterations > 64) {
        return wrong("simulation: iterations", "1 to 64", fmt::format("{}", s.iterations));
    }
    if (s.kernel != DensityKernel::Poly6 && s.iterations < 2) {
        return wrong("simulation: iterations", "2 to 64 with a kernel other than poly6",
                     fmt::format("{}", s.iterations), "give 2 or more, or take poly6");
    }
    if (!finite(s.gravity)) {
        return wrong("simulation: gravity", "finite numbers", shown(s.gravity));
    }
    // Positions are 32-bit floats: this far out their steps are a hundredth of a radius.
    const float farthest = 1e5F * s.radius;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!finite(s.low) || !finite(s.high) || s.low[i] < -farthest || s.high[i] > farthest) {
            return wrong("simulation: domain", fmt::format("corners within {} m (100,000 radii)", farthest),
                         fmt::format("{} to {}", shown(s.low), shown(s.high)),
                         "move it nearer to the origin, or make the radius larger");
        }
        if (s.high[i] - s.low[i] < 4.0F * s.radius) {
            return wrong("simulation: domain", fmt::format("{} m (4 radii) or more each way", 4.0F * s.radius),
                         fmt::format("{} to {}", shown(s.low), shown(s.high)), "make it wider, or the radius smaller");
        }
    }
    for (std::size_t i = 0; i < s.solids.size(); ++i) {
        if (Status status = checkSolid(s.solids[i], i); !status) {
            return status;
        }
    }
    if (const std::size_t within = solidsWithin(s).size(); within > kMaxSolids) {
        return wrong("simulation: solids", fmt::format("at most {} that reach into the domain", kMaxSolids),
                     fmt::format("{}", within), "leave some out, or make the domain smaller");
    }
    if (Status status = checkFluids(s); !status) {
        return status;
    }
    if (Status status = checkBodies(s.bodies, s.low, s.high); !status) {
        return status;
    }
    if (Status status = checkBodiesApart(s); !status) {
        return status;
    }
    if (s.meshed() && !s.bodies.empty()) {
        return wrong("simulation: bodies", "none among meshes, which bodies do not meet",
                     fmt::format("{}", s.bodies.size()), "leave out the bodies, or the meshes");
    }
    if (s.seen != nullptr) {
        if (!s.bodies.empty()) {
            return wrong("simulation: bodies", "none beside a depth field, which bodies do not meet",
                         fmt::format("{}", s.bodies.size()), "leave out the bodies, or set depth_scale to 0");
        }
        if (Status status = checkDepthField(*s.seen, s.radius); !status) {
            return status;
        }
    }
    return checkSources(s.sources, s.radius, s.low, s.high, s.solids, s.meshes.get());
}

Status checkParticles(const SimulationSettings& settings, std::span<const float> positions,
                      std::span<const float> velocities, std::span<const std::uint32_t> fluids) {
    if (Status status = checkFluidNumbers(settings, fluids, positions.size() / 3); !status) {
        return status;
    }
    if ((positions.empty() && settings.sources.emitters.empty()) || positions.size() % 3 != 0 ||
        (!velocities.empty() && velocities.size() != positions.size())) {
        return wrong("simulation: particles", "triples, and velocities for all or none",
                     fmt::format("{} and {} numbers", positions.size(), velocities.size()));
    }
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Triple x{positions[i], positions[i + 1], positions[i + 2]};
        const std::string thing = fmt::format("particle {}", i / 3);
        if (!finite(x) || (!velocities.empty() && !finite(velocities.subspan(i, 3)))) {
            return wrong(thing, "finite position and velocity",
                         velocities.empty() ? shown(x) : shown(x) + " and " + shown(velocities.subspan(i, 3)));
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (x[axis] < settings.low[axis] || x[axis] > settings.high[axis]) {
                return wrong(
                    thing, fmt::format("a position in the domain, {} to {}", shown(settings.low), shown(settings.high)),
                    shown(x), "move it into the domain, or make the domain wider");
            }
        }
        for (std::size_t body = 0; body < settings.bodies.size(); ++body) {
            if (contactWith(solidOf(settings.bodies[body], startOf(settings.bodies[body])), wide(x)).distance < 0.0) {
                return wrong(thing, fmt::format("a position outside body {}", body), shown(x));
            }
        }
        for (std::size_t solid = 0; solid < settings.solids.size(); ++solid) {
            if (distanceTo(settings.solids[solid], x) < 0.0) {
                return wrong(thing, fmt::format("a position outside solid {}", solid), shown(x));
            }
        }
        if (settings.meshed() && contactWith(*settings.meshes, wide(x)).distance < 0.0) {
            return wrong(thing, "a position outside the meshes", shown(x));
        }
    }
    return {};
}

}  // namespace sluice::vk
