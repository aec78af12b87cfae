// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/log.hpp"
#include "app/looks.hpp"
#include "app/needs.hpp"
#include "app/plugin_path.hpp"
#include "app/render_inputs.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

/// "+ pass   reason" is kept, "- pass   reason" is left out, anything else is about the passes' images.
Json lineJson(const std::string& line) {
    const bool pass = line.starts_with("+ ") || line.starts_with("- ");
    if (!pass) {
        return {{"note", line.substr(std::min(line.find_first_not_of(' '), line.size()))}};
    }
    const std::size_t name_end = std::min(line.find(' ', 2), line.size());
    const std::size_t reason = std::min(line.find_first_not_of(' ', name_end), line.size());
    return {{"pass", line.substr(2, name_end - 2)}, {"kept", line[0] == '+'}, {"reason", line.substr(reason)}};
}

struct FirstFrame {
    std::uint32_t particles = 0;
    bool mixed = false;  ///< of several fluids, and each says which
};

Result<FirstFrame> firstFrame(const RenderInputs& inputs) {
    if (inputs.live) {
        return FirstFrame{inputs.live->settings.max_particles, true};
    }
    const scene::ParticleSource& source = inputs.scene.particles;
    const Result<std::filesystem::path> path = particlePath(source, inputs.frames.first);
    const Result<particles::ParticleSet> set =
        path ? loadParticles(source, path.value()) : Result<particles::ParticleSet>{path.error()};
    if (!set) {
        return set.error();
    }
    warnOfRadius(inputs.scene_file, source, set.value(), path.value());
    return FirstFrame{static_cast<std::uint32_t>(set.value().count()), !fluidsOf(set.value(), inputs.scene).empty()};
}

void print(const ExplainOptions& options, const SluiceSceneNeeds& needs, const std::vector<std::string>& lines) {
    if (!options.json) {
        fmt::print("{}: {}x{}, {} particles\n", options.scene, needs.width, needs.height, needs.particle_count);
        for (const std::string& line : lines) {
            fmt::print("{}\n", line);
        }
        return;
    }
    Json passes = Json::array();
    Json notes = Json::array();
    for (const std::string& line : lines) {
        Json item = lineJson(line);
        if (item.contains("pass")) {
            passes.push_back(std::move(item));
        } else {
            notes.push_back(item["note"]);
        }
    }
    const Json document{
        {"sluice", SLUICE_VERSION},          {"scene", options.scene}, {"size", {needs.width, needs.height}},
        {"particles", needs.particle_count}, {"passes", passes},       {"notes", notes}};
    fmt::print("{}\n", document.dump(2, ' ', false, Json::error_handler_t::replace));
}

}  // namespace

int explain(const ExplainOptions& options) {
    RenderOptions reading;
    reading.scene = options.scene;
    reading.particles = options.particles;
    reading.size = options.size;
    const Result<RenderInputs> inputs = readScene(reading);
    if (!inputs) {
        logError(inputs.error());
        return kExitBadInput;
    }
    const scene::Scene& scene = inputs.value().scene;
    const Result<FirstFrame> first = firstFrame(inputs.value());
    if (!first) {
        logError(first.error());
        return kExitBadInput;
    }
    const Result<host::PluginLibrary> library = loadPlugin(options.plugin);
    if (!library) {
        logError(library.error());
        return kExitNoFluid;
    }
    const std::uint32_t outputs =
        options.layers ? SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_NORMAL) | SLUICE_ROLE_BIT(SLUICE_IMAGE_FLUID_THICKNESS) : 0;
    const SluiceSceneNeeds needs =
        sceneNeeds(scene, inputs.value().size, first.value().particles, outputs, first.value().mixed);
    std::vector<std::string> lines;
    SluiceError error{};
    error.struct_size = sizeof(error);
    const auto sink = [](void* user, const char* line) {
        static_cast<std::vector<std::string>*>(user)->emplace_back(line);
    };
    if (library.value().api().explain(&needs, sink, &lines, &error) != SLUICE_OK) {
        log(SLUICE_LOG_ERROR, error.message);
        return kExitNoFluid;
    }
    print(options, needs, lines);
    return kExitOk;
}

}  // namespace sluice::cli
