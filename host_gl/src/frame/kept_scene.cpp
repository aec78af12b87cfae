// SPDX-License-Identifier: MIT
#include "frame/kept_scene.hpp"

#include <cstddef>
#include <span>
#include <type_traits>

#include "sluice/abi_sizes.hpp"
#include "sluice/simulation_arrays.hpp"

namespace sluice::host {

namespace {

template <typename T>
void copy(std::vector<T>& to, const T* from, std::size_t count) {
    if (from == nullptr) {
        to.clear();
    } else {
        to.assign(from, from + count);
    }
}

template <typename T>
const T* view(const std::vector<T>& from) {
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
    copy(fluid_, known.fluid, known.count);
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
    has_simulation_ = has_start_ = false;
    arrays_.clear();
    if (simulation == nullptr) {
        return;
    }
    simulation_facts_ = readAbiStruct(*simulation);
    has_velocities_ = simulation_facts_.velocity != nullptr;
    eachArray(simulation_facts_, has_velocities_,
              [&](const char* /*name*/, const auto* array, std::size_t elements, std::size_t /*most*/) {
                  const auto bytes = std::as_bytes(std::span(array, elements));
                  arrays_.emplace_back(bytes.begin(), bytes.end());
              });
    has_simulation_ = true;
}

std::optional<SluiceSimulation> KeptScene::simulation() const {
    if (!has_simulation_) {
        return std::nullopt;
    }
    SluiceSimulation simulation = simulation_facts_;
    auto kept = arrays_.begin();
    eachArray(simulation, has_velocities_,
              [&](const char* /*name*/, auto& array, std::size_t elements, std::size_t /*most*/) {
                  using Array = std::remove_reference_t<decltype(array)>;
                  array = elements > 0 ? static_cast<Array>(static_cast<const void*>(kept->data())) : nullptr;
                  ++kept;
              });
    return simulation;
}

void KeptScene::keep(const SluiceStart& start) {
    const SluiceStart known = readAbiStruct(start);
    const std::size_t floats = std::size_t{known.particle_count} * 3;
    has_start_ = false;  // should memory run out half-way
    copy(start_position_, known.position, floats);
    copy(start_velocity_, known.velocity, floats);
    copy(start_fluids_, known.particle_fluids, known.particle_count);
    has_start_ = true;
}

std::optional<SluiceStart> KeptScene::start() const {
    if (!has_start_) {
        return std::nullopt;
    }
    auto start = sized<SluiceStart>();
    start.particle_count = static_cast<std::uint32_t>(start_position_.size() / 3);
    start.position = view(start_position_);
    start.velocity = view(start_velocity_);
    start.particle_fluids = view(start_fluids_);
    return start;
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
    particles.fluid = view(fluid_);
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
