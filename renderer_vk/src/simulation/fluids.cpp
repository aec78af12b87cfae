// SPDX-License-Identifier: MIT
#include "simulation/fluids.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "simulation/settings.hpp"

namespace sluice::vk {
namespace {

bool denser(const Fluid& a, const Fluid& b) {
    return a.density < b.density;
}

Error wrong(const std::string& thing, const std::string& expected, const std::string& found,
            const std::string& remedy = "") {
    return {SLUICE_ERROR_INVALID_ARGUMENT, thing, fmt::format("expected {}, found {}", expected, found), remedy};
}

}  // namespace

double densityRatio(std::span<const Fluid> fluids) {
    if (fluids.empty()) {
        return 1.0;
    }
    const auto [light, heavy] = std::minmax_element(fluids.begin(), fluids.end(), denser);
    return double{heavy->density} / double{light->density};
}

Status checkFluids(std::span<const Fluid> fluids) {
    if (fluids.size() > kMaxFluids) {
        return wrong("simulation: fluids", fmt::format("at most {}", kMaxFluids), fmt::format("{}", fluids.size()),
                     "leave some out");
    }
    for (std::size_t i = 0; i < fluids.size(); ++i) {
        const struct {
            const char* name;
            float value, low, high;
        } ranges[] = {{"density", fluids[i].density, 0.001F, 1000.0F},
                      {"viscosity", fluids[i].viscosity, 0.0F, 1.0F},
                      {"tension", fluids[i].tension, 0.0F, 100.0F},
                      {"adhesion", fluids[i].adhesion, 0.0F, 100.0F}};
        for (const auto& range : ranges) {
            if (!(range.value >= range.low && range.value <= range.high)) {
                return wrong(fmt::format("simulation: fluid {}: {}", i, range.name),
                             fmt::format("a number in [{}, {}]", range.low, range.high),
                             fmt::format("{}", range.value));
            }
        }
    }
    if (const double ratio = densityRatio(fluids); ratio > kMostDensityRatio) {
        const auto [light, heavy] = std::minmax_element(fluids.begin(), fluids.end(), denser);
        return wrong("simulation: fluids",
                     fmt::format("a heaviest at most {} times as dense as the lightest", kMostDensityRatio),
                     fmt::format("{} and {}, {:.3g} times", heavy->density, light->density, ratio),
                     "beyond that steps were not stable; bring the densities nearer to each other");
    }
    return {};
}

Status checkFluids(const SimulationSettings& settings) {
    const std::size_t known = std::max<std::size_t>(settings.fluids.size(), 1);
    for (std::size_t i = 0; i < settings.sources.emitters.size(); ++i) {
        if (settings.sources.emitters[i].fluid >= known) {
            return wrong(fmt::format("simulation: emitter {}", i), fmt::format("a fluid below {}", known),
                         fmt::format("{}", settings.sources.emitters[i].fluid));
        }
    }
    return checkFluids(std::span(settings.fluids));
}

Status checkFluidNumbers(const SimulationSettings& settings, std::span<const std::uint32_t> fluids,
                         std::size_t particles) {
    if (!fluids.empty() && fluids.size() != particles) {
        return wrong("simulation: particles", fmt::format("a fluid for each of {} or for none", particles),
                     fmt::format("{} numbers of fluids", fluids.size()));
    }
    const std::size_t known = std::max<std::size_t>(settings.fluids.size(), 1);
    const auto unknown = std::find_if(fluids.begin(), fluids.end(), [known](std::uint32_t i) { return i >= known; });
    if (unknown != fluids.end()) {
        return wrong(fmt::format("particle {}", unknown - fluids.begin()), fmt::format("a fluid below {}", known),
                     fmt::format("{}", *unknown));
    }
    return {};
}

Status checkChange(std::span<const Fluid> before, std::span<const Fluid> after) {
    if (after.size() != before.size()) {
        return wrong("flow: fluids", fmt::format("the {} that it began with", before.size()),
                     fmt::format("{}", after.size()));
    }
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (after[i].density != before[i].density) {
            return wrong(fmt::format("flow: fluid {}: density", i),
                         fmt::format("the {} that it began with", before[i].density),
                         fmt::format("{}", after[i].density), "what flows keeps its mass");
        }
    }
    return {};
}

SimulationSettings withoutNeedlessFluids(const SimulationSettings& settings) {
    SimulationSettings plain = settings;
    if (plain.fluids.size() == 1 && plain.fluids[0].density == 1.0F) {
        plain.viscosity = plain.fluids[0].viscosity;
        plain.tension = plain.fluids[0].tension;
        plain.adhesion = plain.fluids[0].adhesion;
        plain.fluids.clear();
    }
    return plain;
}

FluidBlock fluidBlock(const Fluid& fluid) {
    return {{fluid.density, 1.0F / fluid.density, fluid.viscosity, fluid.tension}, {fluid.adhesion, 0, 0, 0}};
}

}  // namespace sluice::vk
