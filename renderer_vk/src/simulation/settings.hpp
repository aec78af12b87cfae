// SPDX-License-Identifier: MIT
// What a simulation is told: the fluid, the box that holds it and the solids in it. Pure: no Vulkan type.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "simulation/bodies.hpp"
#include "simulation/density_kernel.hpp"
#include "simulation/depth_field.hpp"
#include "simulation/distance_grid.hpp"
#include "simulation/fluids.hpp"
#include "simulation/solid.hpp"
#include "simulation/sources.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// Of those that reach into the domain.
inline constexpr std::uint32_t kMaxSolids = 64;
/// Position-based fluid; docs/simulation.md has every term. Metres, seconds.
struct SimulationSettings {
    float radius = 0.02F;                  ///< of a particle; at rest they are 2 radii apart
    Triple low{-1, 0, -1}, high{1, 2, 1};  ///< the domain: no centre comes nearer to its faces than a radius
    Triple gravity{0, -9.81F, 0};          ///< m/s^2
    std::uint32_t iterations = 4;          ///< of the density constraint per step, 1 to 64
    float relaxation = 0.1F;               ///< epsilon of the constraint, times 1/h^2
    float tensile = 0.0005F;               ///< k of the artificial pressure, times h^2
    float viscosity = 0.02F;               ///< c of XSPH, 0 to 1
    float vorticity = 0.0F;                ///< epsilon of vorticity confinement, m/s; not 0: momentum is not kept
    float tension = 0.0F;                  ///< gamma of Akinci et al. 2013, m/s^2; water about 1
    float adhesion = 0.0F;                 ///< beta of the same, towards walls
    float cfl = 0.4F;                      ///< supports that a particle may fly in one step
    float overshoot = 0.17F;    ///< most that g H dt^2 / (d^2 iterations) may be, H the depth; 0: not held to
    std::vector<Fluid> fluids;  ///< none: one of density 1, with the viscosity, tension and adhesion above
    std::vector<Solid> solids;
    DensityKernel kernel = DensityKernel::Poly6;
    SourceSettings sources;
    std::vector<Body> bodies;
    std::shared_ptr<const DistanceGrid> meshes;  ///< may be none; not with bodies, which would not meet it
    std::shared_ptr<const DepthField> seen;      ///< to begin with; none: there will never be one. Not with bodies

    [[nodiscard]] bool meshed() const { return meshes != nullptr && !meshes->nodes.empty(); }
    /// Tension or adhesion, of any fluid.
    [[nodiscard]] bool tense() const;
    [[nodiscard]] float support() const { return 4.0F * radius; }
};

/// What may change while a fluid flows.
struct FlowSettings {
    std::uint32_t iterations = 4;
    Triple gravity{0, -9.81F, 0};
    float viscosity = 0.02F, vorticity = 0.0F, tension = 0.0F, adhesion = 0.0F;
    std::vector<Emitter> emitters;
    std::vector<Fluid> fluids;  ///< none: as they are. Else all, and they take the place of the three numbers above
};
/// The settings with that in them.
void apply(const FlowSettings& flow, SimulationSettings& settings);

/// The solids that reach into the domain. The others, such as a floor that is the domain's own lower face, would only
/// count that face twice.
[[nodiscard]] std::vector<Solid> solidsWithin(const SimulationSettings& settings);

/// The first setting that is not finite or out of its range, named.
[[nodiscard]] Status checkSettings(const SimulationSettings& settings);
/// The first particle that is not finite, outside the domain or within a solid, named. Velocities and numbers of
/// fluids: empty or as many.
[[nodiscard]] Status checkParticles(const SimulationSettings& settings, std::span<const float> positions,
                                    std::span<const float> velocities, std::span<const std::uint32_t> fluids = {});

}  // namespace sluice::vk
