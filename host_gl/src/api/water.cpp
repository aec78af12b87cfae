// SPDX-License-Identifier: MIT
#include "api/water.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

#include "sluice/abi_sizes.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::host {

namespace {

using Vec3 = std::array<double, 3>;

// A million particles take lavapipe seconds a frame and a graphics card some 20 ms; ten times that is a slip of the
// radius's decimal point.
constexpr std::uint64_t kMostParticles = 10'000'000;

/// What emitters may add where nobody says how much: some frames a second on a CPU, and nothing to a graphics card.
constexpr std::uint32_t kEmitted = 100'000;

// As scenes have them (docs/simulation.md tells what each does).
constexpr float kRelaxation = 0.1F;
constexpr float kTensile = 0.0005F;
constexpr float kCfl = 0.4F;

Vec3 vec(const float (&v)[3]) {
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}

double length(const Vec3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double boxDistance(const SluiceSolid& solid, const Vec3& p) {
    const double angle = double{solid.turn_degrees} * std::numbers::pi / 180.0;
    const Vec3 d = minus(p, vec(solid.a));
    const Vec3 turned{std::cos(angle) * d[0] - std::sin(angle) * d[2], d[1],
                      std::sin(angle) * d[0] + std::cos(angle) * d[2]};
    Vec3 out{};
    double inside = -1e30;
    for (std::size_t i = 0; i < 3; ++i) {
        const double over = std::abs(turned[i]) - vec(solid.b)[i];
        out[i] = std::max(over, 0.0);
        inside = std::max(inside, over);
    }
    return inside < 0.0 ? inside : length(out);
}

/// Metres outside of the solid; negative inside.
double distance(const SluiceSolid& solid, const Vec3& p) {
    switch (solid.kind) {
        case SLUICE_SOLID_PLANE:
            return dot(minus(p, vec(solid.b)), vec(solid.a)) / std::max(length(vec(solid.a)), 1e-30);
        case SLUICE_SOLID_SPHERE:
            return length(minus(p, vec(solid.a))) - double{solid.radius};
        case SLUICE_SOLID_CAPSULE: {
            const Vec3 along = minus(vec(solid.b), vec(solid.a));
            const double t =
                std::clamp(dot(minus(p, vec(solid.a)), along) / std::max(dot(along, along), 1e-30), 0.0, 1.0);
            const Vec3 d = minus(p, vec(solid.a));
            return length({d[0] - t * along[0], d[1] - t * along[1], d[2] - t * along[2]}) - double{solid.radius};
        }
        default:
            return boxDistance(solid, p);
    }
}

Error wrong(const char* field, std::string detail, const char* remedy) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, std::string("water.") + field, std::move(detail), remedy};
}

bool finite(std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

Status check(const SluiceWater& w) {
    if (!std::isfinite(w.radius) || w.radius <= 0.0F) {
        return wrong("radius", fmt::format("{} is not a positive length in metres", w.radius), "0.05 is a start");
    }
    if (w.block_count > 0 && w.blocks == nullptr) {
        return wrong("blocks", fmt::format("it is NULL with a count of {}", w.block_count),
                     "give their address, or a count of 0");
    }
    const std::uint32_t known = std::max(w.fluid_count, 1U);
    for (std::uint32_t i = 0; i < w.block_count; ++i) {
        if (w.blocks[i].fluid >= known) {
            return wrong("blocks",
                         fmt::format("block {} is of fluid {}, and there are {}", i, w.blocks[i].fluid, known),
                         "number fluids from 0, in the order of water.fluids");
        }
    }
    if (w.solid_count > kMostSolids || (w.solid_count > 0 && w.solids == nullptr)) {
        return wrong("solids",
                     fmt::format("expected at most {}, found {}{}", kMostSolids, w.solid_count,
                                 w.solids == nullptr ? " at NULL" : ""),
                     "give fewer, and an address");
    }
    if (w.steps_per_second == 0 || w.iterations == 0) {
        return wrong("steps_per_second and iterations",
                     fmt::format("expected at least 1 of each, found {} and {}", w.steps_per_second, w.iterations),
                     "start from sluice_water_defaults");
    }
    if (!finite(w.low) || !finite(w.high) || !finite(w.gravity)) {
        return wrong("low, high and gravity", "one of their numbers is not finite", "start from sluice_water_defaults");
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const float room = std::array{w.high[0] - w.low[0], w.high[1] - w.low[1], w.high[2] - w.low[2]}[i];
        if (room < 4.0F * w.radius) {
            return wrong("high", fmt::format("the box is {} m wide along axis {}, less than two particles", room, i),
                         "low and high are opposite corners; is the radius too large?");
        }
    }
    return {};
}

struct Lattice {
    std::array<std::uint64_t, 3> count{};
    [[nodiscard]] std::uint64_t sites() const { return count[0] * count[1] * count[2]; }
};

std::string shown(const float (&v)[3]) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

Result<Lattice> latticeOf(const SluiceBlock& block, std::size_t number, float radius) {
    Lattice lattice;
    double sites = 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double room = vec(block.high)[i] - vec(block.low)[i];
        // What rounding took from a block of a whole number of spacings is given back.
        const double fit = std::floor(room / (2.0 * double{radius}) + 1e-3);
        if (!std::isfinite(fit) || !finite(block.velocity)) {
            return wrong("blocks", fmt::format("a number of block {} is not finite", number), "give finite metres");
        }
        if (fit < 1.0) {
            return wrong(
                "blocks",
                fmt::format("block {}, {} to {}, is {:.6g} m wide along axis {} and holds no particle of radius {} m",
                            number, shown(block.low), shown(block.high), room, i, radius),
                room < 0.0 ? "low is the corner with the smaller numbers, high the one with the larger"
                           : "make it at least two radii wide, or water.radius smaller");
        }
        sites *= std::max(fit, 0.0);
        lattice.count.at(i) = static_cast<std::uint64_t>(std::clamp(fit, 0.0, double{kMostParticles}));
    }
    if (sites > double{kMostParticles}) {
        return wrong("blocks",
                     fmt::format("block {} holds {:.0f} particles of radius {} m, {} are the limit", number, sites,
                                 radius, kMostParticles),
                     "make water.radius larger or the block smaller");
    }
    return lattice;
}

Status fill(Water& water, const SluiceWater& asked, std::size_t number, const Lattice& lattice) {
    const SluiceBlock& block = asked.blocks[number];
    const std::span solids(asked.solids, asked.solid_count);
    const float radius = asked.radius;
    const double spacing = 2.0 * double{radius};
    for (std::uint64_t i = 0; i < lattice.sites(); ++i) {
        const std::array<std::uint64_t, 3> site{i % lattice.count[0], i / lattice.count[0] % lattice.count[1],
                                                i / lattice.count[0] / lattice.count[1]};
        Vec3 p{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // A perfect lattice falls as one; a twentieth of a radius off it, by a hash of the number, does not.
            const std::uint64_t hash = (i * 3 + axis + 1) * 0x9e3779b97f4a7c15U;
            const double off = (static_cast<double>(hash >> 40) * 0x1p-24 - 0.5) * 0.1 * double{radius};
            p.at(axis) = vec(block.low).at(axis) + spacing * (static_cast<double>(site.at(axis)) + 0.5) + off;
        }
        const bool free = std::all_of(solids.begin(), solids.end(), [&](const SluiceSolid& solid) {
            return distance(solid, p) >= 0.5 * double{radius};
        });
        for (std::size_t axis = 0; free && axis < 3; ++axis) {
            const auto at = static_cast<float>(p.at(axis));
            if (double{at} < vec(asked.low).at(axis) || double{at} > vec(asked.high).at(axis)) {
                return wrong(
                    "blocks",
                    fmt::format("block {}, {} to {}, sticks out of the box, {} to {}, along axis {}", number,
                                shown(block.low), shown(block.high), shown(asked.low), shown(asked.high), axis),
                    "make the block smaller, or water.low and water.high wider");
            }
            water.position.push_back(at);
            water.velocity.push_back(static_cast<float>(vec(block.velocity).at(axis)));
        }
        if (free) {
            water.fluid.push_back(block.fluid);
        }
    }
    return {};
}

SluiceSimulation settingsOf(const SluiceWater& asked, std::uint32_t particles) {
    auto s = sized<SluiceSimulation>();
    s.frames_in_flight = 1;
    s.radius = asked.radius;
    std::copy_n(asked.low, 3, s.low);
    std::copy_n(asked.high, 3, s.high);
    std::copy_n(asked.gravity, 3, s.gravity);
    s.iterations = asked.iterations;
    s.relaxation = kRelaxation;
    s.tensile = kTensile;
    s.viscosity = asked.viscosity;
    s.vorticity = asked.vorticity;
    s.cfl = kCfl;
    s.longest_step = 1.0 / static_cast<double>(asked.steps_per_second);
    s.tension = asked.tension;
    s.adhesion = asked.adhesion;
    s.max_particles = asked.max_particles == 0 && asked.emitter_count > 0 ? particles + kEmitted : asked.max_particles;
    s.solid_count = asked.solid_count;
    s.solids = asked.solids;
    s.emitter_count = asked.emitter_count;
    s.emitters = asked.emitters;
    s.drain_count = asked.drain_count;
    s.drains = asked.drains;
    s.field_count = asked.field_count;
    s.fields = asked.fields;
    s.body_count = asked.body_count;
    s.bodies = asked.bodies;
    s.path_point_count = asked.path_point_count;
    s.path_points = asked.path_points;
    s.mesh_count = asked.mesh_count;
    s.meshes = asked.meshes;
    s.mesh_corner_count = asked.mesh_corner_count;
    s.mesh_corners = asked.mesh_corners;
    s.mesh_triangle_count = asked.mesh_triangle_count;
    s.mesh_indices = asked.mesh_indices;
    s.depth_scale = asked.depth_scale;
    s.depth_thickness = asked.depth_thickness;
    s.fluid_count = asked.fluid_count;
    s.fluids = asked.fluids;
    return s;
}

}  // namespace

SluiceSimulation Water::view() const {
    SluiceSimulation out = settings;
    out.particle_count = count();
    out.position = position.data();
    out.velocity = velocity.data();
    out.particle_fluids = fluid.data();
    out.particle_fluid_count = static_cast<std::uint32_t>(fluid.size());
    return out;
}

SluiceWater defaultWater() {
    auto water = sized<SluiceWater>();
    water.radius = 0.05F;
    for (std::size_t i = 0; i < 3; ++i) {
        water.low[i] = i == 1 ? 0.0F : -1.0F;
        water.high[i] = i == 1 ? 2.0F : 1.0F;
    }
    water.gravity[1] = -9.81F;
    water.iterations = 4;
    water.steps_per_second = 240;
    water.viscosity = 0.02F;
    return water;
}

SluiceFlow flowOf(const SluiceWater& water) {
    auto flow = sized<SluiceFlow>();
    flow.iterations = water.iterations;
    std::copy_n(water.gravity, 3, flow.gravity);
    flow.viscosity = water.viscosity;
    flow.vorticity = water.vorticity;
    flow.tension = water.tension;
    flow.adhesion = water.adhesion;
    flow.emitter_count = water.emitters != nullptr ? std::min(water.emitter_count, SLUICE_MAX_EMITTERS) : 0;
    std::copy_n(water.emitters, flow.emitter_count, flow.emitters);
    flow.fluid_count = water.fluids != nullptr ? std::min(water.fluid_count, SLUICE_MAX_FLUIDS) : 0;
    std::copy_n(water.fluids, flow.fluid_count, flow.fluids);
    return flow;
}

Result<Water> makeWater(const SluiceWater& asked) {
    if (Status status = check(asked); !status) {
        return status.error();
    }
    Water water;
    for (std::size_t i = 0; i < asked.block_count; ++i) {
        const Result<Lattice> lattice = latticeOf(asked.blocks[i], i, asked.radius);
        if (!lattice) {
            return lattice.error();
        }
        if (lattice.value().sites() + water.count() > kMostParticles) {
            return wrong("blocks", fmt::format("together they hold more than {} particles", kMostParticles),
                         "make water.radius larger or the blocks smaller");
        }
        if (Status status = fill(water, asked, i, lattice.value()); !status) {
            return status.error();
        }
    }
    if (water.count() == 0 && asked.block_count > 0) {
        return wrong("blocks", "they hold no particle outside of the solids",
                     "move them out of the solids, or leave them out if an emitter is to fill the box");
    }
    if (water.count() == 0 && asked.emitter_count == 0) {
        return wrong("blocks", "there are none, and there is no emitter", "give a block of fluid, or an emitter");
    }
    if (asked.fluid_count == 0) {
        water.fluid.clear();
    }
    water.settings = settingsOf(asked, water.count());
    if (Status status = checkArrays(water.view()); !status) {
        return status.error();
    }
    return water;
}

}  // namespace sluice::host
