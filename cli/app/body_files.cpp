// SPDX-License-Identifier: MIT
#include "app/body_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/atomic_file.hpp"

namespace sluice::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kShapes[] = {"sphere", "capsule", "box"};

const char* nameOf(simulator::Body::Shape shape) {
    return kShapes[static_cast<std::size_t>(shape)];
}

template <std::size_t N>
std::array<float, N> numbers(const Json& value) {
    const auto wanted = value.get<std::array<float, N>>();
    for (const float number : wanted) {
        if (!std::isfinite(number)) {
            throw std::invalid_argument("a number is not finite");
        }
    }
    return wanted;
}

host::MovingBody bodyOf(const Json& item, const scene::ParticleSource& source) {
    host::MovingBody body{};
    const auto shape = item.at("shape").get<std::string>();
    if (shape != kShapes[0] && shape != kShapes[1] && shape != kShapes[2]) {
        throw std::invalid_argument(fmt::format("a body has the shape \"{}\"", shape));
    }
    body.box = shape == kShapes[2];
    body.centre = numbers<3>(item.at("centre"));
    body.half = numbers<3>(item.at("half"));
    body.turn = numbers<4>(item.at("turn"));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (body.half.at(axis) <= 0.0F) {
            throw std::invalid_argument("a body has no extent");
        }
        body.centre.at(axis) = source.scale * body.centre.at(axis) + source.translate.at(axis);
        body.half.at(axis) *= source.scale;
    }
    return body;
}

}  // namespace

std::filesystem::path bodiesPath(const std::filesystem::path& particles) {
    std::filesystem::path path = particles;
    path.replace_extension(".bodies.json");
    return path;
}

Status writeBodies(const std::filesystem::path& particles, const simulator::Setup& setup,
                   const std::vector<simulator::BodyPose>& poses) {
    Json bodies = Json::array();
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const simulator::BodyPose& pose = poses[i];
        bodies.push_back({{"shape", nameOf(setup.bodies[i].shape)},
                          {"half", setup.bodies[i].half},
                          {"centre", pose.centre},
                          {"turn", pose.turn},
                          {"velocity", pose.velocity},
                          {"spin", pose.spin},
                          {"force", pose.force},
                          {"torque", pose.torque}});
    }
    return writeTextFile(bodiesPath(particles), Json{{"bodies", bodies}}.dump(1) + "\n");
}

Result<std::vector<host::MovingBody>> readBodies(const scene::Scene& scene, const std::filesystem::path& particles) {
    std::vector<host::MovingBody> bodies;
    if (scene.simulation.bodies.empty()) {
        return bodies;
    }
    const std::filesystem::path path = bodiesPath(particles);
    try {
        std::ifstream file(path);
        if (!file) {
            return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(), "cannot be opened, and the scene has bodies",
                         "sluice simulate writes it beside the particles"};
        }
        const Json document = Json::parse(file);
        for (const Json& item : document.at("bodies")) {
            bodies.push_back(bodyOf(item, scene.particles));
        }
    } catch (const std::exception& failure) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path.string(),
                     fmt::format("is not a file of bodies: {}", failure.what()), "sluice simulate writes one"};
    }
    return bodies;
}

}  // namespace sluice::cli
