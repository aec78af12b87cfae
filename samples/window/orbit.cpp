// SPDX-License-Identifier: MIT
#include "orbit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace window {
namespace {

constexpr float kFieldOfView = 50.0F;  // degrees, vertical
constexpr float kLowest = 3.0F, kHighest = 85.0F;
constexpr float kNearest = 1.5F, kFarthest = 15.0F;

glm::vec4 viewport(glm::ivec2 size) {
    return {0.0F, 0.0F, static_cast<float>(size.x), static_cast<float>(size.y)};
}

}  // namespace

Orbit dragged(Orbit orbit, glm::vec2 pixels) {
    orbit.azimuth = std::remainder(orbit.azimuth - kDegreesAPixel * pixels.x, 360.0F);
    orbit.elevation = std::clamp(orbit.elevation + kDegreesAPixel * pixels.y, kLowest, kHighest);
    return orbit;
}

Orbit zoomed(Orbit orbit, float clicks) {
    orbit.distance = std::clamp(orbit.distance * std::pow(0.9F, clicks), kNearest, kFarthest);
    return orbit;
}

glm::vec3 eyeOf(const Orbit& orbit) {
    const float azimuth = glm::radians(orbit.azimuth);
    const float elevation = glm::radians(orbit.elevation);
    return orbit.target + orbit.distance * glm::vec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                                     std::cos(elevation) * std::cos(azimuth));
}

glm::mat4 viewOf(const Orbit& orbit) {
    return glm::lookAt(eyeOf(orbit), orbit.target, glm::vec3(0.0F, 1.0F, 0.0F));
}

glm::mat4 projectionOf(glm::ivec2 size) {
    return glm::perspective(glm::radians(kFieldOfView), static_cast<float>(size.x) / static_cast<float>(size.y), kNear,
                            kFar);
}

Ray rayThrough(const Orbit& orbit, glm::ivec2 size, glm::ivec2 pixel) {
    const glm::vec3 window(static_cast<float>(pixel.x) + 0.5F, static_cast<float>(size.y - pixel.y) - 0.5F, 1.0F);
    const glm::vec3 far = glm::unProject(window, viewOf(orbit), projectionOf(size), viewport(size));
    const glm::vec3 eye = eyeOf(orbit);
    return {eye, glm::normalize(far - eye)};
}

glm::vec2 pixelOf(const Orbit& orbit, glm::ivec2 size, glm::vec3 point) {
    const glm::vec3 window = glm::project(point, viewOf(orbit), projectionOf(size), viewport(size));
    return {window.x, static_cast<float>(size.y) - window.y};
}

}  // namespace window
