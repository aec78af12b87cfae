// SPDX-License-Identifier: MIT
#include "app/start_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "app/log.hpp"
#include "app/looks.hpp"
#include "app/simulate_setup.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::cli {
namespace {

/// Formats keep 32-bit floats; whoever wrote one in text may have rounded it.
constexpr double kSameRadius = 1e-3;

bool within(const scene::FluidBox& box, const float* x) {
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        inside = inside && x[axis] > box.low.at(axis) && x[axis] < box.high.at(axis);
    }
    return inside;
}

Status checkPlaces(const scene::Simulation& simulation, const simulator::Setup& setup,
                   const particles::ParticleSet& set) {
    const auto refused = [&](std::size_t i, const std::string& expected, const std::string& remedy) {
        const float* x = &set.position[3 * i];
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, simulation.start,
                     fmt::format("particle {}: expected {}, found [{}, {}, {}]", i, expected, x[0], x[1], x[2]),
                     remedy};
    };
    const std::vector<double> clear = simulator::clearances(setup, set.position);
    for (std::size_t i = 0; i < clear.size(); ++i) {
        // Negated so that NaN fails as well.
        if (!(clear[i] >= 0.0)) {
            return refused(i, "a position in the domain, outside solids and bodies",
                           "simulate the file with the same solids, or leave them out");
        }
        for (std::size_t box = 0; box < simulation.fluid.size(); ++box) {
            if (within(simulation.fluid[box], &set.position[3 * i])) {
                return refused(i, fmt::format("a position outside /simulation/fluid/{}", box),
                               "put the box where there is no fluid yet");
            }
        }
    }
    return {};
}

/// What the file cannot say, and the simulation therefore does not begin with.
void warnOfSilence(const scene::Simulation& simulation, const particles::ParticleSet& set) {
    if (simulation.fluids.size() > 1 && set.colour.empty()) {
        log(SLUICE_LOG_WARNING,
            fmt::format(
                "{}: has no colours, so that all of its particles are of the first of /simulation/fluids, which "
                "are {} (begin with the .ply or .bgeo that sluice simulate writes of them)",
                simulation.start, simulation.fluids.size()));
    }
    if (!simulation.bodies.empty()) {
        log(SLUICE_LOG_WARNING,
            fmt::format("{}: holds particles alone, so that /simulation/bodies begin where the scene has them (their "
                        "places in a frame of sluice simulate are in the .bodies.json beside it)",
                        simulation.start));
    }
}

Result<simulator::Particles> readStart(const scene::Simulation& simulation, const simulator::Setup& setup) {
    Result<particles::ParticleSet> read = particles::load(simulation.start, simulation.radius);
    if (!read) {
        return read.error();
    }
    particles::ParticleSet& set = read.value();
    if (std::abs(double{set.radius} - double{simulation.radius}) > kSameRadius * double{simulation.radius}) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, simulation.start,
                     fmt::format("expected particles of the radius of the simulation, {} m, found {} m",
                                 simulation.radius, set.radius),
                     "set /simulation/radius to that of the file"};
    }
    if (set.count() > kMostSimulated) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, simulation.start,
                     fmt::format("expected at most {} particles, found {}", kMostSimulated, set.count()),
                     "begin with fewer"};
    }
    if (Status status = checkPlaces(simulation, setup, set); !status) {
        return status.error();
    }
    warnOfSilence(simulation, set);
    simulator::Particles start;
    if (!simulation.fluids.empty()) {
        start.fluid.resize(set.count());
        for (std::size_t i = 0; i < set.count() && !set.colour.empty(); ++i) {
            start.fluid[i] = nearestFluid(simulation.fluids, &set.colour[3 * i]);
        }
    }
    start.position = std::move(set.position);
    start.velocity = std::move(set.velocity);
    start.velocity.resize(start.position.size());  // at rest
    return start;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

bool hasFluid(const scene::Simulation& simulation) {
    return !simulation.start.empty() || !simulation.fluid.empty() || !simulation.emitters.empty();
}

Result<simulator::Particles> wholeStart(const scene::Simulation& simulation, const simulator::Setup& setup,
                                        std::uint64_t seed) {
    if (simulation.start.empty()) {
        return startOfFluid(simulation, setup, seed);
    }
    Result<simulator::Particles> start = readStart(simulation, setup);
    if (!start || simulation.fluid.empty()) {
        return start;
    }
    Result<simulator::Particles> more = startOfFluid(simulation, setup, seed);
    if (!more) {
        return more;
    }
    simulator::Particles& all = start.value();
    append(all.position, more.value().position);
    append(all.velocity, more.value().velocity);
    append(all.fluid, more.value().fluid);
    if (all.position.size() / 3 > kMostSimulated) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "/simulation/fluid",
                     fmt::format("expected at most {} particles with those of {}, found {}", kMostSimulated,
                                 simulation.start, all.position.size() / 3),
                     "make the boxes smaller"};
    }
    return start;
}

}  // namespace sluice::cli
