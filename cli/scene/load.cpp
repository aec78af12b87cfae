// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

#include "sluice/scene/scene.hpp"

namespace sluice::scene {
namespace {

void resolve(std::string& path, const std::filesystem::path& folder) {
    if (!path.empty() && std::filesystem::path(path).is_relative()) {
        path = (folder / path).lexically_normal().string();
    }
}

}  // namespace

Result<Scene> loadScene(const std::filesystem::path& path) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), "is a folder", "name the scene's JSON file"};
    }
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), std::strerror(errno),
                     "name an existing scene file; samples/ has some"};
    }
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    Result<Scene> scene = parseScene(text, path.string());
    if (scene) {
        resolve(scene.value().particles.path, path.parent_path());
        resolve(scene.value().environment, path.parent_path());
        resolve(scene.value().simulation.start, path.parent_path());
        resolve(scene.value().simulation.depth.path, path.parent_path());
        for (SolidMesh& mesh : scene.value().simulation.meshes) {
            resolve(mesh.path, path.parent_path());
        }
    }
    return scene;
}

}  // namespace sluice::scene
