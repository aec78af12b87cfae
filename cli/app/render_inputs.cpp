// SPDX-License-Identifier: MIT
#include "app/render_inputs.hpp"

#include <set>

namespace sluice::cli {

Result<RenderInputs> readScene(const RenderOptions& options) {
    Result<scene::Scene> read = scene::loadScene(options.scene);
    if (!read) {
        return read.error();
    }
    RenderInputs inputs;
    inputs.scene = std::move(read).value();
    if (!options.particles.empty()) {
        inputs.scene.particles.path = options.particles;
    }
    if (options.view) {
        inputs.scene.fluid.view = *options.view;
    }
    inputs.frames = options.frames.value_or(inputs.scene.frames);
    inputs.size = options.size.value_or(inputs.scene.size);
    return inputs;
}

Result<std::filesystem::path> particlePath(const scene::ParticleSource& source, std::int64_t frame) {
    if (source.path.empty()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "/particles/path", "the scene names no particle file",
                     "add it to the scene, or give --particles FILE"};
    }
    return particles::Sequence{source.path}.path(frame);
}

void transform(particles::ParticleSet& set, const scene::ParticleSource& source) {
    for (std::size_t i = 0; i < set.position.size(); ++i) {
        set.position[i] = set.position[i] * source.scale + source.translate[i % 3];
    }
    for (float& component : set.velocity) {
        component *= source.scale;
    }
    set.radius *= source.scale;
}

Result<particles::ParticleSet> loadParticles(const scene::ParticleSource& source, const std::filesystem::path& path) {
    Result<particles::ParticleSet> set = particles::load(path, source.radius);
    if (set) {
        transform(set.value(), source);
    }
    return set;
}

Status checkInputs(RenderInputs& inputs) {
    if (!inputs.scene.environment.empty()) {
        Result<Environment> map = loadEnvironment(inputs.scene.environment);
        if (!map) {
            return map.error();
        }
        inputs.environment = std::move(map).value();
    }
    std::set<std::filesystem::path> seen;
    for (std::int64_t frame = inputs.frames.first; frame <= inputs.frames.last; ++frame) {
        const Result<std::filesystem::path> path = particlePath(inputs.scene.particles, frame);
        if (!path) {
            return path.error();
        }
        if (!seen.insert(path.value()).second) {
            break;  // not numbered: every frame reads the same file
        }
        const Result<particles::ParticleSet> set = loadParticles(inputs.scene.particles, path.value());
        if (!set) {
            return set.error();
        }
    }
    return {};
}

SluiceParticles particleView(const particles::ParticleSet& set) {
    SluiceParticles view{};
    view.struct_size = sizeof(view);
    view.count = static_cast<std::uint32_t>(set.count());
    view.radius = set.radius;
    view.position = set.position.data();
    view.velocity = set.velocity.empty() ? nullptr : set.velocity.data();
    view.colour = set.colour.empty() ? nullptr : set.colour.data();
    return view;
}

}  // namespace sluice::cli
