// SPDX-License-Identifier: MIT
#include "frame/kept_scene.hpp"

#include <cstddef>

#include "sluice/abi_sizes.hpp"

namespace sluice::host {

namespace {

void copy(std::vector<float>& to, const float* from, std::size_t count) {
    if (from == nullptr) {
        to.clear();
    } else {
        to.assign(from, from + count);
    }
}

const float* view(const std::vector<float>& from) {
    return from.empty() ? nullptr : from.data();
}

}  // namespace

void KeptScene::keep(const SluiceParticles& particles) {
    // Only what the renderer has been able to read may be read here.
    const SluiceParticles known = readAbiStruct(particles);
    const std::size_t floats = std::size_t{known.count} * 3;
    has_particles_ = false;  // should memory run out half-way
    copy(position_, known.position, floats);
    copy(velocity_, known.velocity, floats);
    copy(colour_, known.colour, floats);
    particle_facts_ = known;
    has_particles_ = true;
}

void KeptScene::keep(const SluiceEnvironment* environment) {
    environment_facts_ = SluiceEnvironment{};
    pixels_.clear();
    if (environment == nullptr) {
        return;
    }
    const SluiceEnvironment known = readAbiStruct(*environment);
    copy(pixels_, known.pixels, std::size_t{known.width} * known.height * 3);
    environment_facts_ = known;
}

void KeptScene::keep(const SluiceSimulation* simulation) {
    start_.clear();
    if (simulation == nullptr) {
        return;
    }
    const SluiceSimulation known = readAbiStruct(*simulation);
    const std::size_t floats = std::size_t{known.particle_count} * 3;
    solids_.assign(known.solids, known.solids + known.solid_count);
    copy(start_velocity_, known.velocity, floats);
    simulation_facts_ = known;
    copy(start_, known.position, floats);
}

std::optional<SluiceSimulation> KeptScene::simulation() const {
    if (start_.empty()) {
        return std::nullopt;
    }
    SluiceSimulation simulation = simulation_facts_;
    simulation.solids = solids_.data();
    simulation.position = view(start_);
    simulation.velocity = view(start_velocity_);
    return simulation;
}

std::optional<SluiceParticles> KeptScene::particles() const {
    if (!has_particles_) {
        return std::nullopt;
    }
    auto particles = sized<SluiceParticles>();
    particles.count = particle_facts_.count;
    particles.radius = particle_facts_.radius;
    particles.position = view(position_);
    particles.velocity = view(velocity_);
    particles.colour = view(colour_);
    return particles;
}

std::optional<SluiceEnvironment> KeptScene::environment() const {
    if (pixels_.empty()) {
        return std::nullopt;
    }
    auto environment = sized<SluiceEnvironment>();
    environment.width = environment_facts_.width;
    environment.height = environment_facts_.height;
    environment.pixels = pixels_.data();
    return environment;
}

}  // namespace sluice::host
