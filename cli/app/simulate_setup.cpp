// SPDX-License-Identifier: MIT
#include "app/simulate_setup.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

namespace sluice::cli {
namespace {

void addEngine(simulator::Setup& setup, const host::EngineScene& engine) {
    setup.planes.push_back({{0, 1, 0}, {0, engine.floor_height, 0}});
    for (const host::Pillar& pillar : engine.pillars) {
        const host::Vec3 top{pillar.base[0], pillar.base[1] + pillar.height, pillar.base[2]};
        setup.capsules.push_back({pillar.base, top, pillar.radius});
    }
    for (const host::Crate& crate : engine.crates) {
        const float half = crate.size / 2.0F;
        setup.boxes.push_back({crate.centre, {half, half, half}, crate.turn_degrees});
    }
    for (const host::Basin& basin : engine.basins) {
        const float wall = basin.wall / 2.0F;
        const float up = basin.height / 2.0F;
        for (const float side : {-1.0F, 1.0F}) {
            setup.boxes.push_back(
                {{basin.centre[0] + side * (basin.half_x + wall), basin.centre[1] + up, basin.centre[2]},
                 {wall, up, basin.half_z + basin.wall},
                 0.0F});
            setup.boxes.push_back(
                {{basin.centre[0], basin.centre[1] + up, basin.centre[2] + side * (basin.half_z + wall)},
                 {basin.half_x + basin.wall, up, wall},
                 0.0F});
        }
    }
}

/// What comes, goes and moves.
void addSources(simulator::Setup& setup, const scene::Simulation& s) {
    for (const scene::Emitter& e : s.emitters) {
        setup.emitters.push_back({e.shape == scene::kEmitterDisc, e.centre, e.direction, e.width, e.height, e.speed,
                                  e.rate, e.start, e.stop, e.fluid});
    }
    for (const scene::Drain& drain : s.drains) {
        setup.drains.push_back({drain.shape == scene::kDrainSphere, drain.centre, drain.half});
    }
    for (const scene::ForceField& f : s.fields) {
        using Kind = simulator::ForceField::Kind;
        const Kind kind = f.kind == scene::kFieldWind    ? Kind::Wind
                          : f.kind == scene::kFieldPoint ? Kind::Point
                                                         : Kind::Vortex;
        setup.fields.push_back({kind, f.centre, f.axis, f.strength, f.radius});
    }
    for (const scene::MovingBody& b : s.bodies) {
        using Shape = simulator::Body::Shape;
        const Shape shape = b.shape == scene::kBodySphere    ? Shape::Sphere
                            : b.shape == scene::kBodyCapsule ? Shape::Capsule
                                                             : Shape::Box;
        simulator::Body body{shape, b.centre, b.half, b.turn_degrees, b.density, b.velocity, b.spin, {}};
        for (const scene::PathPoint& point : b.path) {
            body.path.push_back({point.time, point.centre, point.turn_degrees});
        }
        setup.bodies.push_back(std::move(body));
    }
    setup.most_particles = static_cast<std::uint32_t>(kMostSimulated);
}

/// SplitMix64 (Steele et al. 2014): the n-th number of a seed.
std::uint64_t mixed(std::uint64_t seed, std::uint64_t n) {
    std::uint64_t z = seed + (n + 1) * 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/// In [-1, 1).
double random(std::uint64_t seed, std::uint64_t n) {
    return static_cast<double>(mixed(seed, n) >> 11) * 0x1p-52 - 1.0;
}

std::array<std::uint64_t, 3> sites(const scene::FluidBox& box, double spacing) {
    std::array<std::uint64_t, 3> count{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // What rounding took from a box of a whole number of spacings is given back.
        count[axis] =
            static_cast<std::uint64_t>(std::floor((double{box.high[axis]} - double{box.low[axis]}) / spacing + 1e-3));
    }
    return count;
}

}  // namespace

simulator::Setup simulationSetup(const scene::Scene& scene) {
    const scene::Simulation& s = scene.simulation;
    simulator::Setup setup;
    setup.radius = s.radius;
    setup.low = s.low;
    setup.high = s.high;
    setup.gravity = s.gravity;
    setup.iterations = s.iterations;
    setup.kernel = s.kernel == SLUICE_KERNEL_SPLINE     ? simulator::Kernel::Spline
                   : s.kernel == SLUICE_KERNEL_WENDLAND ? simulator::Kernel::Wendland
                                                        : simulator::Kernel::Poly6;
    setup.relaxation = s.relaxation;
    setup.tensile = s.tensile;
    setup.viscosity = s.viscosity;
    setup.vorticity = s.vorticity;
    setup.cfl = s.cfl;
    setup.tension = s.tension;
    setup.adhesion = s.adhesion;
    setup.overshoot = s.overshoot;
    for (const scene::FluidKind& fluid : s.fluids) {
        setup.fluids.push_back({fluid.density, fluid.viscosity, fluid.tension, fluid.adhesion});
    }
    for (const scene::SolidSphere& sphere : s.spheres) {
        setup.spheres.push_back({sphere.centre, sphere.radius});
    }
    for (const scene::SolidCapsule& capsule : s.capsules) {
        setup.capsules.push_back({capsule.from, capsule.to, capsule.radius});
    }
    for (const scene::SolidBox& box : s.boxes) {
        setup.boxes.push_back({box.centre, box.half, box.turn_degrees});
    }
    for (const scene::SolidPlane& plane : s.planes) {
        setup.planes.push_back({plane.normal, plane.through});
    }
    addSources(setup, s);
    if (s.collide_with_engine != 0 && s.collide == scene::kCollideSolids) {
        addEngine(setup, scene.engine);
    }
    return setup;
}

Result<simulator::Particles> startOfFluid(const scene::Simulation& simulation, const simulator::Setup& setup,
                                          std::uint64_t seed) {
    const double spacing = 2.0 * double{simulation.radius};
    double expected = 0.0;
    for (const scene::FluidBox& box : simulation.fluid) {
        const auto count = sites(box, spacing);
        expected += static_cast<double>(count[0]) * static_cast<double>(count[1]) * static_cast<double>(count[2]);
    }
    if (expected > static_cast<double>(kMostSimulated)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "/simulation/fluid",
                     fmt::format("expected at most {} particles, found boxes for {:.0f} of radius {} m", kMostSimulated,
                                 expected, simulation.radius),
                     "make /simulation/radius larger or the boxes smaller"};
    }
    simulator::Particles all;
    std::uint64_t number = 0;
    for (const scene::FluidBox& box : simulation.fluid) {
        const auto count = sites(box, spacing);
        for (std::uint64_t i = 0; i < count[0] * count[1] * count[2]; ++i) {
            const std::array<std::uint64_t, 3> site{i % count[0], i / count[0] % count[1], i / count[0] / count[1]};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                all.position.push_back(
                    static_cast<float>(double{box.low.at(axis)} + spacing * (static_cast<double>(site.at(axis)) + 0.5) +
                                       double{simulation.jitter} * double{simulation.radius} * random(seed, number++)));
                all.velocity.push_back(box.velocity.at(axis));
            }
            all.fluid.push_back(box.fluid);
        }
    }
    // Jitter may take half a radius from what a particle at a wall has.
    const std::vector<double> clear = simulator::clearances(setup, all.position);
    simulator::Particles particles;
    for (std::size_t i = 0; i < all.position.size(); ++i) {
        if (clear[i / 3] >= 0.5 * double{simulation.radius}) {
            particles.position.push_back(all.position[i]);
            particles.velocity.push_back(all.velocity[i]);
            if (i % 3 == 0 && !simulation.fluids.empty()) {
                particles.fluid.push_back(all.fluid[i / 3]);
            }
        }
    }
    if (particles.position.empty() && simulation.emitters.empty()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "/simulation/fluid",
                     fmt::format("expected boxes that hold particles of radius {} m outside the solids, or an emitter, "
                                 "found none",
                                 simulation.radius),
                     "docs/cli.md shows one; samples/dam_break.json has it"};
    }
    return particles;
}

std::uint64_t replayHash(const simulator::Particles& particles, std::uint64_t hash) {
    const auto add = [&hash](const std::vector<float>& values) {
        for (const float value : values) {
            const auto bits = std::bit_cast<std::uint32_t>(value);
            for (int byte = 0; byte < 4; ++byte) {
                hash = (hash ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100000001b3U;
            }
        }
    };
    add(particles.position);
    add(particles.velocity);
    return hash;
}

}  // namespace sluice::cli
