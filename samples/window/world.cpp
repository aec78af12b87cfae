// SPDX-License-Identifier: MIT
#include "world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

namespace window {
namespace {

constexpr float kRimHeight = 0.25F, kRimWidth = 0.12F;

Box rim(glm::vec3 centre, glm::vec3 half) {
    return {centre, half, 0.0F, Surface::Stone, {0.78F, 0.76F, 0.72F}, false};
}

const std::array<Box, 8> kBoxes{{
    {{0.9F, 0.8F, -0.55F}, {0.15F, 0.8F, 0.15F}, 0.0F, Surface::Paint, {0.9F, 0.08F, 0.06F}},
    {{0.9F, 0.8F, 0.65F}, {0.15F, 0.8F, 0.15F}, 0.0F, Surface::Stone, {0.85F, 0.8F, 0.7F}},
    {{-0.1F, 0.22F, 0.1F}, {0.22F, 0.22F, 0.22F}, 20.0F, Surface::Wood, {0.95F, 0.75F, 0.5F}},
    {{-0.35F, 0.16F, 0.85F}, {0.16F, 0.16F, 0.16F}, 50.0F, Surface::Wood, {0.8F, 0.65F, 0.5F}},
    rim({kLow.x - kRimWidth, kRimHeight / 2, 0.0F}, {kRimWidth, kRimHeight / 2, kHigh.z + 2 * kRimWidth}),
    rim({kHigh.x + kRimWidth, kRimHeight / 2, 0.0F}, {kRimWidth, kRimHeight / 2, kHigh.z + 2 * kRimWidth}),
    rim({0.0F, kRimHeight / 2, kLow.z - kRimWidth}, {kHigh.x, kRimHeight / 2, kRimWidth}),
    rim({0.0F, kRimHeight / 2, kHigh.z + kRimWidth}, {kHigh.x, kRimHeight / 2, kRimWidth}),
}};

/// About +y by `degrees`, as glRotatef does.
glm::vec3 turned(glm::vec3 v, float degrees) {
    const float c = std::cos(glm::radians(degrees));
    const float s = std::sin(glm::radians(degrees));
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

/// Distance along the ray at which it enters the box: the slabs of its three axes.
std::optional<float> enters(const Box& box, const Ray& ray) {
    const glm::vec3 from = turned(ray.origin - box.centre, -box.turn);
    const glm::vec3 along = turned(ray.direction, -box.turn);
    float first = 0.0F;
    float last = std::numeric_limits<float>::max();
    for (int axis = 0; axis < 3; ++axis) {
        if (along[axis] == 0.0F) {
            if (std::abs(from[axis]) > box.half[axis]) {
                return std::nullopt;
            }
            continue;
        }
        const float a = (-box.half[axis] - from[axis]) / along[axis];
        const float b = (box.half[axis] - from[axis]) / along[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last ? std::optional(first) : std::nullopt;
}

}  // namespace

std::span<const Box> boxes() {
    return kBoxes;
}

const Box& redPillar() {
    return kBoxes[0];
}

std::vector<SluiceSolid> solids() {
    std::vector<SluiceSolid> all;
    for (const Box& box : kBoxes) {
        if (!box.solid) {
            continue;
        }
        SluiceSolid solid{};
        solid.kind = SLUICE_SOLID_BOX;
        for (int axis = 0; axis < 3; ++axis) {
            solid.a[axis] = box.centre[axis];
            solid.b[axis] = box.half[axis];
        }
        solid.turn_degrees = box.turn;
        all.push_back(solid);
    }
    return all;
}

std::optional<glm::vec3> hit(const Ray& ray) {
    std::optional<float> nearest;
    if (ray.direction.y < 0.0F) {
        nearest = -ray.origin.y / ray.direction.y;
    }
    for (const Box& box : kBoxes) {
        const std::optional<float> at = enters(box, ray);
        if (at && (!nearest || *at < *nearest)) {
            nearest = at;
        }
    }
    if (!nearest) {
        return std::nullopt;
    }
    return ray.origin + *nearest * ray.direction;
}

glm::vec3 raised(glm::vec3 place, float radius) {
    for (const Box& box : kBoxes) {
        // About the box, however it is turned.
        const float reach = std::hypot(box.half.x, box.half.z) + radius;
        const float top = box.centre.y + box.half.y + radius;
        if (box.solid && std::hypot(place.x - box.centre.x, place.z - box.centre.z) < reach) {
            place.y = std::max(place.y, top);
        }
    }
    return place;
}

}  // namespace window
