// SPDX-License-Identifier: MIT
#include "app/render_files.hpp"

#include <functional>
#include <string>
#include <system_error>

#include "app/file_roles.hpp"
#include "app/interrupt.hpp"
#include "app/outputs.hpp"
#include "app/plugin_path.hpp"

namespace sluice::cli {
namespace {

constexpr const char* kPicture = "the picture (-o)";
constexpr const char* kLayers = "the layers (--layers)";
constexpr const char* kTrace = "the trace (--trace)";
constexpr const char* kLedgerLog = "the ledger's log (--ledger-log)";

FileRoles inputRoles(const RenderOptions& options, const RenderInputs& inputs) {
    FileRoles roles;
    std::error_code ignored;
    roles.add("the scene file", options.scene);
    if (!inputs.scene.environment.empty()) {
        roles.add("the environment map", inputs.scene.environment);
    }
    for (const scene::SolidMesh& mesh : inputs.scene.simulation.meshes) {
        roles.add("the mesh file", mesh.path);
    }
    if (!inputs.scene.simulation.start.empty()) {
        roles.add("the file of the start", inputs.scene.simulation.start);
    }
    if (!options.no_fluid) {
        for (const std::filesystem::path& place : pluginPlaces(options.plugin)) {
            roles.add("the renderer plugin", place);
        }
    }
    if (inputs.live) {
        return roles;
    }
    std::filesystem::path last;
    for (std::int64_t frame = inputs.frames.first; frame <= inputs.frames.last && !interrupted(); ++frame) {
        const Result<std::filesystem::path> path = particlePath(inputs.scene.particles, frame);
        // One file for all frames, or a missing one, about which checkInputs has more to say.
        if (!path || path.value() == last || !std::filesystem::exists(path.value(), ignored)) {
            break;
        }
        roles.add("the particle file", path.value());
        last = path.value();
    }
    return roles;
}

using Visit = std::function<Status(const char* role, const std::filesystem::path&)>;

/// Calls `visit` for the pictures and layers of every frame until it fails.
Status forEachFrameFile(const RenderOptions& options, scene::FrameRange frames, const Visit& visit) {
    for (std::int64_t frame = frames.first; frame <= frames.last && !interrupted(); ++frame) {
        for (const auto& [role, pattern] :
             {std::pair{kPicture, &options.output}, std::pair{kLayers, &options.layers}}) {
            if (pattern->empty()) {
                continue;
            }
            const Result<std::filesystem::path> path = outputPath(*pattern, frame);
            if (!path) {
                return path.error();
            }
            if (Status status = visit(role, path.value()); !status) {
                return status;
            }
        }
    }
    return {};
}

}  // namespace

Status checkRoles(const RenderOptions& options, const RenderInputs& inputs) {
    FileRoles roles = inputRoles(options, inputs);
    if (!options.trace.empty()) {
        if (Status status = roles.addOutput(kTrace, options.trace); !status) {
            return status;
        }
    }
    if (!options.ledger_log.empty()) {
        if (Status status = roles.addOutput(kLedgerLog, options.ledger_log); !status) {
            return status;
        }
    }
    // Pictures and layers differ from each other by frame number and ending (checkOutputs), so they need not be
    // remembered, however many frames there are.
    return forEachFrameFile(options, inputs.frames, [&roles](const char* role, const std::filesystem::path& path) {
        return roles.check(role, path);
    });
}

Status prepareOutputs(OutputFolders& folders, const RenderOptions& options, scene::FrameRange frames) {
    for (const std::string* file : {&options.trace, &options.ledger_log}) {
        if (file->empty()) {
            continue;
        }
        if (Status status = folders.prepare(*file); !status) {
            return status;
        }
    }
    return forEachFrameFile(options, frames, [&folders](const char* /*role*/, const std::filesystem::path& path) {
        return folders.prepare(path);
    });
}

}  // namespace sluice::cli
