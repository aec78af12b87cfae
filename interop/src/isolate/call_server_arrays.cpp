// SPDX-License-Identifier: MIT
// Calls of the host whose arrays lie in sealed memory.
#include "isolate/call_server.hpp"
#include "isolate/simulation_memory.hpp"
#include "sluice/abi_boundary.hpp"
#include "sluice/isolate/sealed_memory.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::isolate {

Message Server::handle(const SetParticles& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    auto particles = sized<SluiceParticles>();
    particles.count = call.count;
    particles.radius = call.radius;
    Mapping memory;
    if (!fds_.empty()) {
        const std::size_t floats = std::size_t{3} * call.count;
        const std::size_t arrays = 1U + (call.has_velocity != 0 ? 1U : 0U) + (call.has_colour != 0 ? 1U : 0U);
        const std::size_t numbers = call.has_fluid != 0 ? call.count : 0;
        Result<Mapping> mapped =
            mapSealed(fds_.front(), arrays * floats * sizeof(float) + numbers * sizeof(std::uint32_t));
        if (!mapped) {
            writeAbiError(&error, mapped.error());
            return said(mapped.error().code, error);
        }
        memory = std::move(mapped).value();
        const auto* next = static_cast<const float*>(memory.at());
        particles.position = next;
        if (call.has_velocity != 0) {
            particles.velocity = next += floats;
        }
        if (call.has_colour != 0) {
            particles.colour = next += floats;
        }
        if (call.has_fluid != 0) {
            particles.fluid = static_cast<const std::uint32_t*>(static_cast<const void*>(next + floats));
        }
    }
    const SluiceResult result = api_.set_particles(renderer_, &particles, &error);
    return said(result, error);
}

Message Server::handle(const SetSimulation& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (!simulates(error)) {
        return said(SLUICE_ERROR_UNSUPPORTED, error);
    }
    if (fds_.empty()) {
        const SluiceResult result = api_.set_simulation(renderer_, nullptr, &error);
        return said(result, error);
    }
    SluiceSimulation simulation = call.simulation;
    const auto refuse = [&](const Error& why) {
        (void)api_.set_simulation(renderer_, nullptr, nullptr);  // on failure there is none
        writeAbiError(&error, why);
        return said(why.code, error);
    };
    if (const Status served = checkServed(simulation, api_); !served) {
        return refuse(served.error());
    }
    const Result<Mapping> mapped = placeArrays(simulation, call.has_velocity != 0, fds_.front());
    if (!mapped) {
        return refuse(mapped.error());
    }
    const SluiceResult result = api_.set_simulation(renderer_, &simulation, &error);
    return said(result, error);
}

Message Server::handle(const ResetSimulation& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (api_.reset_simulation == nullptr) {
        writeAbiError(&error,
                      {SLUICE_ERROR_UNSUPPORTED, "the plugin", "does not know reset_simulation", "use a newer one"});
        return said(SLUICE_ERROR_UNSUPPORTED, error);
    }
    SluiceStart start = call.start;
    start.position = start.velocity = nullptr;
    start.particle_fluids = nullptr;
    const std::size_t floats = std::size_t{3} * start.particle_count;
    Mapping memory;
    if (!fds_.empty()) {
        const std::size_t triples = call.has_velocity != 0 ? 2 : 1;
        const std::size_t numbers = call.has_fluids != 0 ? start.particle_count : 0;
        Result<Mapping> mapped =
            mapSealed(fds_.front(), triples * floats * sizeof(float) + numbers * sizeof(std::uint32_t));
        if (!mapped) {
            writeAbiError(&error, mapped.error());
            return said(mapped.error().code, error);
        }
        memory = std::move(mapped).value();
        start.position = static_cast<const float*>(memory.at());
        start.velocity = call.has_velocity != 0 ? start.position + floats : nullptr;
        if (call.has_fluids != 0) {
            const void* behind = start.position + triples * floats;
            start.particle_fluids = static_cast<const std::uint32_t*>(behind);
        }
    }
    const SluiceResult result = api_.reset_simulation(renderer_, &start, &error);
    return said(result, error);
}

Message Server::handle(const SetEnvironment& call, UniqueFd& /*with*/) {
    auto error = sized<SluiceError>();
    if (fds_.empty()) {
        const SluiceResult result = api_.set_environment(renderer_, nullptr, &error);
        return said(result, error);
    }
    const std::size_t floats = std::size_t{3} * call.width * call.height;
    if (call.width > SLUICE_MAX_EXTENT || call.height > SLUICE_MAX_EXTENT) {
        writeAbiError(&error, breachOfHost("it sent an environment map that is too large"));
        return said(SLUICE_ERROR_INVALID_ARGUMENT, error);
    }
    const Result<Mapping> mapped = mapSealed(fds_.front(), floats * sizeof(float));
    if (!mapped) {
        writeAbiError(&error, mapped.error());
        return said(mapped.error().code, error);
    }
    auto environment = sized<SluiceEnvironment>();
    environment.width = call.width;
    environment.height = call.height;
    environment.pixels = static_cast<const float*>(mapped.value().at());
    const SluiceResult result = api_.set_environment(renderer_, &environment, &error);
    return said(result, error);
}

}  // namespace sluice::isolate
