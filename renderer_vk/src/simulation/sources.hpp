// SPDX-License-Identifier: MIT
// Where fluid comes from, where it goes, and what blows on it. Pure: no Vulkan type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simulation/distance_grid.hpp"
#include "simulation/solid.hpp"
#include "sluice/result.hpp"

namespace sluice::vk {

/// A nozzle. Particles leave it in layers, each a square lattice of spacing 2r, one layer 2r or more behind the other.
struct Emitter {
    bool disc = true;              ///< or a rectangle
    Triple centre{};               ///< of the opening, metres
    Triple direction{0, -1, 0};    ///< out of it; any length but 0
    float width = 0.1F;            ///< metres; a disc's diameter
    float height = 0.1F;           ///< the rectangle's other side; horizontal is `width`, or x if it looks up or down
    float speed = 1.0F;            ///< m/s, > 0
    float rate = 0.0F;             ///< particles per second; 0: layer upon layer, as dense as water at rest
    float start = 0.0F, stop = 0;  ///< seconds of the simulation's time; stop 0: never
    std::uint32_t fluid = 0;       ///< what comes out of it
};

/// What takes every particle that ends a step in it.
struct Drain {
    bool sphere = true;  ///< or a box along the axes
    Triple centre{};
    Triple half{};  ///< metres; a sphere's radius is the first
};

enum class ForceKind : std::uint32_t { Wind = 0, Point = 1, Vortex = 2 };

/// An acceleration. Wind blows along `axis`, a point pulls towards `centre` (pushes, if strength < 0), a vortex turns
/// about the line through `centre` along `axis`.
struct ForceField {
    ForceKind kind = ForceKind::Wind;
    Triple centre{};
    Triple axis{0, 1, 0};   ///< of any length but 0; not used by a point
    float strength = 0.0F;  ///< m/s^2, where it is strongest
    float radius = 0.0F;    ///< beyond it there is nothing, and within (1 - (d / radius)^2)^2; 0: everywhere the same
};

inline constexpr std::size_t kMaxEmitters = 16, kMaxDrains = 16, kMaxFields = 16;

struct SourceSettings {
    std::vector<Emitter> emitters;
    std::vector<Drain> drains;
    std::vector<ForceField> fields;
    std::uint32_t most_particles = 4'000'000;  ///< at which emitters stop
};

/// Where the particles of one layer leave the opening: a lattice that keeps half a radius from its rim; one place at
/// least.
[[nodiscard]] std::vector<Triple> outletSites(const Emitter& emitter, float radius);
/// Between layers, seconds.
[[nodiscard]] double layerPeriod(const Emitter& emitter, std::size_t sites, float radius);

struct Birth {
    Triple position, velocity;
    std::uint32_t fluid = 0;
};
/// Adds the particles that leave from `from` until just before `to`, where they are at `to`: flown as a step of their
/// age would take them. Ranges that follow each other miss no layer and have none twice.
void addBirths(const Emitter& emitter, std::span<const Triple> sites, float radius, const Triple& gravity, double from,
               double to, std::vector<Birth>& births);

/// Greatest acceleration of all fields together, m/s^2.
[[nodiscard]] double strongest(std::span<const ForceField> fields);

/// The first that is out of its range, named. `low` and `high` are the domain, `solids` all of them, `meshes` may be
/// null.
[[nodiscard]] Status checkSources(const SourceSettings& sources, float radius, const Triple& low, const Triple& high,
                                  std::span<const Solid> solids, const DistanceGrid* meshes = nullptr);

/// Mirrors shaders/simulation/sources.glsl.
struct SourceBlock {
    struct Field {
        std::array<float, 4> centre, axis, reach;
    };
    struct Sink {
        std::array<float, 4> centre, half;
    };
    struct Outlet {
        std::array<float, 4> around;
        std::array<std::uint32_t, 4> births;
    };
    std::array<std::uint32_t, 4> number;
    std::array<Field, kMaxFields> fields;
    std::array<Sink, kMaxDrains> drains;
    std::array<Outlet, kMaxEmitters> outlets;
};
static_assert(sizeof(SourceBlock) == 16 + 48 * kMaxFields + 32 * kMaxDrains + 32 * kMaxEmitters, "std140");
/// Fields and drains; the outlets of a step come with its births.
[[nodiscard]] SourceBlock sourceBlock(const SourceSettings& sources);

/// The births of one step, and in `block` where to look for what is in their way.
[[nodiscard]] std::vector<Birth> birthsOf(const SourceSettings& sources, float radius, const Triple& gravity,
                                          double from, double to, SourceBlock& block);

}  // namespace sluice::vk
