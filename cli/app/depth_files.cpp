// SPDX-License-Identifier: MIT
#include "app/depth_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "image/depth_layer.hpp"
#include "sluice/particles/particles.hpp"

namespace sluice::cli {
namespace {

/// What single precision and another path to the same numbers may make of a matrix.
constexpr float kSame = 1e-4F;

ImageCamera cameraOf(const scene::Scene& scene, std::int64_t frame) {
    const SluiceCamera from = scene::cameraAt(scene, frame, scene.size);
    ImageCamera camera;
    std::copy_n(&from.view[0], 16, camera.view.begin());
    std::copy_n(&from.projection[0], 16, camera.projection.begin());
    camera.near_plane = from.near_plane;
    return camera;
}

float difference(const std::array<float, 16>& a, const std::array<float, 16>& b) {
    float most = 0.0F;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const float apart = std::abs(a.at(i) - b.at(i)) / std::max(1.0F, std::abs(b.at(i)));
        most = std::isfinite(apart) ? std::max(most, apart) : INFINITY;
    }
    return most;
}

Status checkCamera(const std::filesystem::path& path, const DepthLayer& layer, const scene::Scene& scene,
                   std::int64_t frame) {
    const auto wrong = [&](const std::string& expected, const std::string& found) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(),
                     fmt::format("expected {}, found {}", expected, found),
                     "render it anew from this scene, or give the scene the camera and the size of the file"};
    };
    const std::int64_t across = std::int64_t{layer.width} * scene.size.height;
    const std::int64_t down = std::int64_t{layer.height} * scene.size.width;
    // A pixel more or less is what rounding of a smaller picture may make.
    if (std::abs(across - down) > std::max<std::int64_t>(scene.size.width, scene.size.height)) {
        return wrong(fmt::format("pictures of the scene's shape, {}x{}", scene.size.width, scene.size.height),
                     fmt::format("{}x{}", layer.width, layer.height));
    }
    if (!layer.camera) {
        return {};
    }
    const ImageCamera camera = cameraOf(scene, frame);
    const std::string mine = fmt::format("the scene's camera of frame {}", frame);
    if (const float view = difference(layer.camera->view, camera.view); view > kSame) {
        return wrong(mine, fmt::format("one that stands elsewhere (worldToCamera is up to {:.2g} off)", view));
    }
    const float lens = std::max(difference(layer.camera->projection, camera.projection),
                                std::abs(layer.camera->near_plane / camera.near_plane - 1.0F));
    if (!(lens <= kSame)) {
        return wrong(mine, fmt::format("another lens (sluice:projection or sluice:near is up to {:.2g} off)", lens));
    }
    return {};
}

Result<DepthLayer> readDepth(const scene::Scene& scene, std::int64_t frame, const std::filesystem::path& path,
                             bool contents) {
    Result<DepthLayer> layer = readDepthLayer(path, contents);
    if (!layer) {
        return layer;
    }
    if (Status status = checkCamera(path, layer.value(), scene, frame); !status) {
        return status.error();
    }
    return layer;
}

}  // namespace

bool depthMoves(const scene::Simulation& simulation) {
    return particles::Sequence{simulation.depth.path}.numbered();
}

Result<std::vector<std::filesystem::path>> depthFiles(const scene::Simulation& simulation, std::int64_t last) {
    std::vector<std::filesystem::path> files;
    if (simulation.collide != scene::kCollideDepth) {
        return files;
    }
    if (simulation.depth.path.empty()) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, "/simulation/depth/path", "expected a file, found none",
                     "render one: sluice render SCENE --no-fluid --frames 1..1 -o FILE.png --layers FILE.exr"};
    }
    for (std::int64_t frame = 1; frame == 1 || (depthMoves(simulation) && frame < last); ++frame) {
        Result<std::filesystem::path> path = particles::Sequence{simulation.depth.path}.path(frame);
        if (!path) {
            return path.error();
        }
        files.push_back(std::move(path).value());
    }
    return files;
}

Result<std::shared_ptr<const vk::DepthField>> firstDepth(const scene::Scene& scene, std::int64_t last) {
    const auto files = depthFiles(scene.simulation, last);
    if (!files) {
        return files.error();
    }
    for (std::size_t i = 0; i < files.value().size(); ++i) {
        if (const auto layer = readDepth(scene, static_cast<std::int64_t>(i) + 1, files.value()[i], false); !layer) {
            return layer.error();
        }
    }
    return loadDepth(scene, 1);
}

Result<std::shared_ptr<const vk::DepthField>> loadDepth(const scene::Scene& scene, std::int64_t frame) {
    const Result<std::filesystem::path> path = particles::Sequence{scene.simulation.depth.path}.path(frame);
    if (!path) {
        return path.error();
    }
    const Result<DepthLayer> read = readDepth(scene, frame, path.value(), true);
    if (!read) {
        return read.error();
    }
    const DepthLayer& layer = read.value();
    const ImageCamera camera = cameraOf(scene, frame);
    const scene::SeenDepth& how = scene.simulation.depth;
    auto field = simulator::seenDepth({camera.view, camera.projection, camera.near_plane, layer.width, layer.height},
                                      layer.depth, how.scale, how.thickness, scene.simulation.radius);
    if (!field) {
        Error error = field.error();
        error.thing = path.value().string() + ": " + error.thing;
        return error;
    }
    return field;
}

}  // namespace sluice::cli
