// SPDX-License-Identifier: MIT
#include <algorithm>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "sluice/scene/scene.hpp"

namespace sluice::scene {

SluiceCamera cameraAt(const Scene& scene, std::int64_t frame, Size size) {
    const CameraPath& path = scene.camera;
    // In double: a long orbit must come back to where it began.
    const glm::dvec3 target(path.target[0], path.target[1], path.target[2]);
    const glm::dvec3 start(path.position[0], path.position[1], path.position[2]);
    const glm::dvec3 up(path.up[0], path.up[1], path.up[2]);
    const double angle = glm::radians(static_cast<double>(path.orbit_degrees_per_frame) *
                                      static_cast<double>(frame - scene.frames.first));
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 position = target + glm::dvec3(turn * glm::dvec4(start - target, 0.0));
    const glm::mat4 view(glm::lookAtRH(position, target, up));
    const glm::mat4 projection(glm::perspectiveRH_NO(
        glm::radians(static_cast<double>(path.vertical_fov_degrees)), static_cast<double>(size.width) / size.height,
        static_cast<double>(path.near_plane), static_cast<double>(path.far_plane)));
    SluiceCamera camera{};
    std::copy_n(glm::value_ptr(view), 16, &camera.view[0]);
    std::copy_n(glm::value_ptr(projection), 16, &camera.projection[0]);
    camera.near_plane = path.near_plane;
    camera.far_plane = path.far_plane;
    return camera;
}

}  // namespace sluice::scene
