// SPDX-License-Identifier: MIT
#include "app/render_inputs.hpp"

#include <fmt/format.h>

#include <set>
#include <system_error>

#include "app/body_files.hpp"
#include "app/interrupt.hpp"
#include "app/log.hpp"
#include "app/mesh_files.hpp"
#include "app/start_file.hpp"
#include "report/progress.hpp"

namespace sluice::cli {

namespace {

Status startLive(RenderInputs& inputs, const RenderOptions& options, const std::vector<simulator::Mesh>& meshes) {
    if (inputs.frames.first < 1) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "--frames",
                     "expected frames from 1, found 0: the scene simulates its fluid", "frame 1 is the start"};
    }
    if (inputs.scene.simulation.collide == scene::kCollideDepth && inputs.frames.first != 1) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, "--frames",
            fmt::format("expected frames from 1, found {}: the fluid collides with what pictures show, from the "
                        "first on",
                        inputs.frames.first),
            "begin with frame 1, or simulate into files first"};
    }
    Result<LiveFluid> live =
        liveFluid(inputs.scene, meshes, {options.seed, options.frames_in_flight, inputs.frames.last});
    if (!live) {
        Error error = live.error();
        error.thing = options.scene + ": " + error.thing;
        return error;
    }
    inputs.live.emplace(std::move(live).value());
    return {};
}

}  // namespace

Result<RenderInputs> readScene(const RenderOptions& options) {
    Result<scene::Scene> read = scene::loadScene(options.scene);
    if (!read) {
        return read.error();
    }
    RenderInputs inputs;
    inputs.scene = std::move(read).value();
    inputs.scene_file = options.scene;
    if (!options.particles.empty()) {
        inputs.scene.particles.path = options.particles;
    }
    if (options.view) {
        inputs.scene.fluid.view = *options.view;
    }
    inputs.frames = options.frames.value_or(inputs.scene.frames);
    inputs.size = options.size.value_or(inputs.scene.size);
    const Result<std::vector<simulator::Mesh>> meshes = readMeshes(inputs.scene.simulation);
    if (!meshes) {
        return meshes.error();
    }
    inputs.scene.engine.meshes = drawnMeshes(meshes.value());
    if (simulatesLive(inputs.scene)) {
        if (Status status = startLive(inputs, options, meshes.value()); !status) {
            return status.error();
        }
        return inputs;
    }
    if (inputs.scene.particles.path.empty()) {
        return Error{
            SLUICE_ERROR_INVALID_ARGUMENT, options.scene, "/particles/path: the scene names no particle file",
            "give --particles FILE, or set \"particles\": {\"path\": \"FILE\"} in the scene; to make a file: sluice "
            "generate pool -o pool.pos"};
    }
    return inputs;
}

Result<std::filesystem::path> particlePath(const scene::ParticleSource& source, std::int64_t frame) {
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
    Result<particles::ParticleSet> set = particles::load(
        path, source.radius,
        R"(set "particles": {"radius": METRES} in the scene, or give the file one: sluice convert --radius)");
    if (set) {
        transform(set.value(), source);
    }
    return set;
}

void warnOfRadius(const std::string& scene_file, const scene::ParticleSource& source, const particles::ParticleSet& set,
                  const std::filesystem::path& path) {
    if (set.radius_given) {
        log(SLUICE_LOG_WARNING, fmt::format("{}: holds no particle radius; taking the {} m of /particles/radius in {}",
                                            path.string(), source.radius, scene_file));
    }
}

namespace {

/// A pipe would be waited for, a device could have no end.
Status checkRegular(const std::filesystem::path& path) {
    std::error_code ignored;
    const std::filesystem::file_status there = std::filesystem::status(path, ignored);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(),
                     "expected a regular file, found a folder or a device", "name an image file"};
    }
    return {};
}

}  // namespace

Status checkInputs(RenderInputs& inputs, bool progress) {
    if (!inputs.scene.environment.empty()) {
        if (Status status = checkRegular(inputs.scene.environment); !status) {
            return status;
        }
        Result<Environment> map = loadEnvironment(inputs.scene.environment);
        if (!map) {
            return map.error();
        }
        inputs.environment = std::move(map).value();
    }
    if (inputs.live) {
        return {};
    }
    const bool sequence = particles::Sequence{inputs.scene.particles.path}.numbered();
    Progress bar(sequence ? static_cast<std::uint64_t>(inputs.frames.count()) : 1, progress);
    std::set<std::filesystem::path> seen;
    for (std::int64_t frame = inputs.frames.first; frame <= inputs.frames.last && !interrupted(); ++frame) {
        bar.update(seen.size(), fmt::format("checking frame {}", frame));
        const Result<std::filesystem::path> path = particlePath(inputs.scene.particles, frame);
        if (!path) {
            return path.error();
        }
        if (!seen.insert(path.value()).second) {
            break;  // not numbered: every frame reads the same file
        }
        Result<particles::ParticleSet> set = loadParticles(inputs.scene.particles, path.value());
        if (!set) {
            Error error = set.error();
            std::error_code ignored;
            const scene::Simulation& simulation = inputs.scene.simulation;
            if (hasFluid(simulation) && !std::filesystem::exists(path.value(), ignored)) {
                error.remedy = fmt::format("to simulate them: sluice simulate {} -o {}", inputs.scene_file,
                                           inputs.scene.particles.path);
            }
            return error;
        }
        if (const auto bodies = readBodies(inputs.scene, path.value()); !bodies) {
            return bodies.error();
        }
        if (!inputs.first) {
            warnOfRadius(inputs.scene_file, inputs.scene.particles, set.value(), path.value());
            inputs.first = LoadedParticles{path.value(), std::move(set).value()};
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
