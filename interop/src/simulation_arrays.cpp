// SPDX-License-Identifier: MIT
#include "sluice/simulation_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace sluice {
namespace {

Error cameLater(const char* what, unsigned minor, const SluiceRendererApi& api) {
    return {SLUICE_ERROR_UNSUPPORTED, what,
            fmt::format("the plugin serves ABI {}.{}, and that came with 1.{}", api.abi_version >> 16U,
                        api.abi_version & 0xffffU, minor),
            "use a newer plugin, or simulate into files"};
}

/// A function tells of 1.2; what 1.3 brought to the simulation has none.
bool knowsNewest(const SluiceRendererApi& api) {
    return (api.abi_version & 0xffffU) >= 3;
}

}  // namespace

Status checkArrays(const SluiceSimulation& simulation) {
    const SluiceSimulation& s = simulation;
    if (s.particle_count == 0 && s.emitter_count == 0) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation.position",
                     "expected particles or an emitter, found none", ""};
    }
    Status status;
    eachArray(s, s.velocity != nullptr,
              [&](const char* name, const auto* array, std::size_t elements, std::size_t most) {
                  if (status && (elements > most || (elements > 0 && array == nullptr))) {
                      const std::size_t step =
                          most % 3 == 0 && most > SLUICE_MAX_EMITTERS ? 3 : 1;  // triples are told as such
                      status = Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("simulation.{}", name),
                                     fmt::format("expected at most {}, found {}{}", most / step, elements / step,
                                                 array == nullptr ? " at NULL" : ""),
                                     "give fewer, and an address"};
                  }
              });
    if (status && s.particle_fluid_count != 0 && s.particle_fluid_count != s.particle_count) {
        status = Error{SLUICE_ERROR_INVALID_ARGUMENT, "simulation.particle_fluids",
                       fmt::format("expected one for each of {} particles, or none, found {}", s.particle_count,
                                   s.particle_fluid_count),
                       ""};
    }
    return status;
}

Status checkArrays(const SluiceStart& start) {
    if (start.particle_count > kMostSimulatedParticles || (start.particle_count > 0 && start.position == nullptr)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "start.position",
                     fmt::format("expected at most {}, found {}{}", kMostSimulatedParticles, start.particle_count,
                                 start.position == nullptr ? " at NULL" : ""),
                     "give fewer, and an address"};
    }
    return {};
}

Status checkServed(const SluiceSimulation& simulation, const SluiceRendererApi& api) {
    const SluiceSimulation& s = simulation;
    const struct {
        const char* name;
        bool asked;
    } newest[] = {{"simulation.fluids", s.fluid_count > 0},
                  {"simulation.foam_life", s.foam_life != 0.0F},
                  {"simulation.density_kernel", s.density_kernel > SLUICE_KERNEL_POLY6}};
    for (const auto& [name, asked] : newest) {
        if (asked && !knowsNewest(api)) {
            return cameLater(name, 3, api);
        }
    }
    if (api.simulation_bodies != nullptr && api.set_body != nullptr) {
        return {};
    }
    const struct {
        const char* name;
        bool asked;
    } all[] = {{"emitters", s.emitter_count > 0},   {"drains", s.drain_count > 0},
               {"fields", s.field_count > 0},       {"bodies", s.body_count > 0},
               {"meshes", s.mesh_count > 0},        {"tension", s.tension != 0.0F},
               {"adhesion", s.adhesion != 0.0F},    {"overshoot", s.overshoot != 0.0F},
               {"depth_scale", s.depth_scale != 0}, {"anisotropy", s.anisotropy != 0.0F}};
    for (const auto& [name, asked] : all) {
        if (asked) {
            return cameLater(fmt::format("simulation.{}", name).c_str(), 2, api);
        }
    }
    return {};
}

Status checkServed(const SluiceFlow& flow, const SluiceRendererApi& api) {
    return flow.fluid_count > 0 && !knowsNewest(api) ? Status{cameLater("flow.fluids", 3, api)} : Status{};
}

SluiceFlow flowAfter(const std::optional<SluiceFlow>& before, const SluiceFlow& flow) {
    SluiceFlow after = flow;
    if (before && flow.fluid_count == 0) {
        after.fluid_count = before->fluid_count;
        std::copy(std::begin(before->fluids), std::end(before->fluids), std::begin(after.fluids));
    }
    return after;
}

}  // namespace sluice
