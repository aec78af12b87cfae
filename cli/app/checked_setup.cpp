// SPDX-License-Identifier: MIT
#include "app/checked_setup.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "app/simulate_setup.hpp"
#include "sluice/simulation_limits.hpp"

namespace sluice::cli {
namespace {

/// There is no list of all.
constexpr const char* kSolids = "/simulation and /engine: solids";

/// The solver's words for members of lists, and the lists.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kLists{
    {{"emitter", "emitters"}, {"drain", "drains"}, {"field", "fields"}, {"body", "bodies"}, {"fluid", "fluids"}}};

/// Where each of the setup's solids comes from, in the order in which the solver numbers them: spheres, capsules,
/// boxes, planes, the scene's own before the engine's.
std::vector<std::string> placesOfSolids(const scene::Scene& scene) {
    const scene::Simulation& s = scene.simulation;
    const host::EngineScene& engine = scene.engine;
    const bool with_engine = s.collide_with_engine != 0 && s.collide == scene::kCollideSolids;
    std::vector<std::string> places;
    const auto add = [&places](const char* list, std::size_t count, std::size_t each = 1) {
        for (std::size_t i = 0; i < count * each; ++i) {
            places.push_back(fmt::format("{}/{}", list, i / each));
        }
    };
    add("/simulation/spheres", s.spheres.size());
    add("/simulation/capsules", s.capsules.size());
    add("/engine/pillars", with_engine ? engine.pillars.size() : 0);
    add("/simulation/boxes", s.boxes.size());
    add("/engine/crates", with_engine ? engine.crates.size() : 0);
    add("/engine/basins", with_engine ? engine.basins.size() : 0, 4);
    add("/simulation/planes", s.planes.size());
    if (with_engine) {
        places.emplace_back("/engine/floor_height");
    }
    return places;
}

struct Member {
    std::string_view word, rest;
    std::size_t number;
};

/// "emitter 0: rate" in three; none if it does not begin with a word and a number.
std::optional<Member> memberOf(std::string_view text) {
    const std::size_t space = text.find(' ');
    if (space == std::string_view::npos) {
        return std::nullopt;
    }
    Member member{text.substr(0, space), {}, 0};
    const std::string_view after = text.substr(space + 1);
    const auto [end, error] = std::from_chars(after.data(), after.data() + after.size(), member.number);
    if (error != std::errc{}) {
        return std::nullopt;
    }
    member.rest = after.substr(static_cast<std::size_t>(end - after.data()));
    return member;
}

/// The place in the scene of what the solver calls so.
std::string placeOf(std::string_view thing, const std::vector<std::string>& solids) {
    constexpr std::string_view kOf = "simulation: ";
    const std::string_view what = thing.starts_with(kOf) ? thing.substr(kOf.size()) : thing;
    if (what == "solids") {
        return kSolids;
    }
    const std::optional<Member> member = memberOf(what);
    if (!member) {
        return fmt::format("/simulation/{}", what);
    }
    const std::string_view field = member->rest.starts_with(": ") ? member->rest.substr(2) : member->rest;
    const std::string end = field.empty() ? "" : fmt::format("/{}", field);
    if (member->word == "solid" && member->number < solids.size()) {
        return solids[member->number] + end;
    }
    for (const auto& [word, list] : kLists) {
        if (member->word == word) {
            return fmt::format("/simulation/{}/{}{}", list, member->number, end);
        }
    }
    return fmt::format("/simulation/{}", what);
}

/// The solver's error in the scene's words: in the middle of its text solids and bodies are told by number, too.
Error inScene(Error error, const scene::Scene& scene) {
    const std::vector<std::string> solids = placesOfSolids(scene);
    error.thing = placeOf(error.thing, solids);
    constexpr std::string_view kWithin = "lies in ";
    if (const std::size_t at = error.detail.find(kWithin); at != std::string::npos) {
        const std::size_t end = at + kWithin.size();
        if (const auto member = memberOf(std::string_view(error.detail).substr(end))) {
            const std::string place = placeOf(fmt::format("{} {}", member->word, member->number), solids);
            error.detail = error.detail.substr(0, end) + place + std::string(member->rest);
        }
    }
    if (error.remedy.empty()) {
        error.remedy = "docs/cli.md has the range of every key";
    }
    return error;
}

Error tooMany(const char* place, std::size_t most, std::size_t found, const char* what) {
    return {SLUICE_ERROR_INVALID_ARGUMENT, place, fmt::format("expected at most {} {}, found {}", most, what, found),
            "leave some out"};
}

/// How much the plugin's interface carries: to have `sluice simulate` and `sluice render` take the same scenes.
Status checkAmounts(const scene::Scene& scene, const std::vector<simulator::Mesh>& meshes) {
    const scene::Simulation& s = scene.simulation;
    if (const std::size_t solids = placesOfSolids(scene).size(); solids > kMostSolids) {
        return tooMany(kSolids, kMostSolids, solids, "in and out of the domain");
    }
    const std::size_t points =
        std::accumulate(s.bodies.begin(), s.bodies.end(), std::size_t{0},
                        [](std::size_t sum, const scene::MovingBody& body) { return sum + body.path.size(); });
    if (points > kMostPathPoints) {
        return tooMany("/simulation/bodies", kMostPathPoints, points, "points of paths");
    }
    if (s.collide == scene::kCollideDepth) {
        return {};
    }
    if (meshes.size() > kMostMeshes) {
        return tooMany("/simulation/meshes", kMostMeshes, meshes.size(), "meshes");
    }
    std::size_t corners = 0;
    std::size_t triangles = 0;
    for (const simulator::Mesh& mesh : meshes) {
        corners += mesh.corners.size();
        triangles += mesh.triangles.size();
    }
    if (corners > kMostMeshCorners) {
        return tooMany("/simulation/meshes", kMostMeshCorners, corners, "corners");
    }
    if (triangles > kMostMeshTriangles) {
        return tooMany("/simulation/meshes", kMostMeshTriangles, triangles, "triangles");
    }
    return {};
}

/// What no frame could be simulated with, however short its steps.
Status checkSpeeds(const scene::Scene& scene, const simulator::Setup& setup) {
    const scene::Simulation& s = scene.simulation;
    const double most = simulator::fastestAllowed(setup, 1.0 / double{s.frames_per_second});
    const auto tooFast = [&](const char* list, std::size_t number, const char* key, double speed) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, fmt::format("/simulation/{}/{}{}", list, number, key),
                     fmt::format("expected at most {:.4g} m/s, the fastest that the shortest steps of a frame can "
                                 "follow, found {:.4g} m/s",
                                 most, speed),
                     "make it slower, or /simulation/frames_per_second, radius or cfl larger"};
    };
    for (std::size_t i = 0; i < s.fluid.size(); ++i) {
        const auto& v = s.fluid[i].velocity;
        if (const double speed = std::hypot(double{v[0]}, double{v[1]}, double{v[2]}); speed > most) {
            return tooFast("fluid", i, "/velocity", speed);
        }
    }
    for (std::size_t i = 0; i < s.emitters.size(); ++i) {
        if (double{s.emitters[i].speed} > most) {
            return tooFast("emitters", i, "/speed", double{s.emitters[i].speed});
        }
    }
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        const auto& v = s.bodies[i].velocity;
        if (const double speed = simulator::fastestOfBody(setup, i); speed > most) {
            const bool straight = std::hypot(double{v[0]}, double{v[1]}, double{v[2]}) > most;
            return tooFast("bodies", i, !s.bodies[i].path.empty() ? "/path" : straight ? "/velocity" : "/spin", speed);
        }
    }
    return {};
}

}  // namespace

Result<simulator::Setup> checkedSetup(const scene::Scene& scene, const std::vector<simulator::Mesh>& meshes) {
    simulator::Setup setup = simulationSetup(scene);
    // Before the meshes: their distances are as fine as the radius and as wide as the domain, and take their time.
    if (const Status status = simulator::check(setup); !status) {
        return inScene(status.error(), scene);
    }
    if (const Status status = checkSpeeds(scene, setup); !status) {
        return status.error();
    }
    if (const Status status = checkAmounts(scene, meshes); !status) {
        return status.error();
    }
    if (scene.simulation.collide == scene::kCollideDepth || meshes.empty()) {
        return setup;
    }
    if (const Status status = simulator::addMeshes(setup, meshes); !status) {
        return status.error();
    }
    if (const Status status = simulator::check(setup); !status) {
        return inScene(status.error(), scene);
    }
    return setup;
}

}  // namespace sluice::cli
