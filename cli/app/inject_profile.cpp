// SPDX-License-Identifier: MIT
// What a profile and a scene say to an injected program.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app/inject.hpp"
#include "scene/reader.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

namespace {

using inject::CameraRoute;
using inject::OverlaySwitch;
using inject::ViewRule;

template <typename T>
constexpr std::uint32_t number(T value) {
    return static_cast<std::uint32_t>(value);
}

constexpr std::array<scene::Choice, 3> kRoutes{{{"automatic", number(CameraRoute::Automatic)},
                                                {"fixed_function", number(CameraRoute::FixedFunction)},
                                                {"uniforms", number(CameraRoute::Uniforms)}}};
constexpr std::array<scene::Choice, 3> kOverlays{{{"automatic", number(OverlaySwitch::Automatic)},
                                                  {"first", number(OverlaySwitch::First)},
                                                  {"swap", number(OverlaySwitch::Never)}}};
constexpr std::array<scene::Choice, 4> kViewRules{{{"automatic", number(ViewRule::Automatic)},
                                                   {"first_draw", number(ViewRule::FirstDraw)},
                                                   {"pushed", number(ViewRule::Pushed)},
                                                   {"none", number(ViewRule::Identity)}}};
constexpr std::array<scene::Choice, 2> kPlaces{{{"view", 0}, {"world", 1}}};

template <typename T, std::size_t N>
void readRule(scene::ObjectReader& from, std::string_view key, T& out, const std::array<scene::Choice, N>& choices) {
    auto value = number(out);
    from.choice(key, value, choices);
    out = static_cast<T>(value);
}

void readCamera(scene::ObjectReader& camera, inject::TrackerRules& rules) {
    readRule(camera, "route", rules.route, kRoutes);
    readRule(camera, "view", rules.view, kViewRules);
    float near_plane = 0;
    float far_plane = 0;
    camera.number("near", near_plane, scene::kLength);
    camera.number("far", far_plane, scene::kLength);
    if (near_plane > 0) {
        rules.near_plane = near_plane;
    }
    if (far_plane > 0) {
        rules.far_plane = far_plane;
    }
    if (near_plane > 0 && far_plane > 0 && far_plane <= near_plane) {
        camera.fail("far", "a plane beyond near", fmt::format("{}", far_plane));
    }
}

void addEmitters(const std::vector<scene::Emitter>& from, inject::WaterPlan& water) {
    for (const scene::Emitter& e : from) {
        SluiceEmitter& out = water.emitters.emplace_back();
        out.shape = e.shape;
        std::copy(e.centre.begin(), e.centre.end(), &out.centre[0]);
        std::copy(e.direction.begin(), e.direction.end(), &out.direction[0]);
        out.width = e.width;
        out.height = e.height;
        out.speed = e.speed;
        out.rate = e.rate;
        out.start = e.start;
        out.stop = e.stop;
    }
}

void readWater(scene::ObjectReader& from, inject::WaterPlan& water) {
    std::uint32_t place = water.in_view ? 0 : 1;
    from.choice("place", place, kPlaces);
    water.in_view = place == 0;
    from.number("units_per_metre", water.units_per_metre, scene::kLength);
    constexpr float kAbsent = std::numeric_limits<float>::infinity();
    inject::Triple up{kAbsent, 0, 0};
    from.numbers("up", up, scene::kAnyLength);
    from.number("radius", water.radius, scene::Range{0.001, 10.0});
    from.numbers("low", water.low, scene::kAnyLength);
    from.numbers("high", water.high, scene::kAnyLength);
    from.numbers("gravity", water.gravity, scene::Range{-1000.0, 1000.0});
    from.list("blocks", water.blocks, [](scene::ObjectReader& b, inject::WaterBlock& block) {
        b.numbers("low", block.low, scene::kAnyLength);
        b.numbers("high", block.high, scene::kAnyLength);
        b.numbers("velocity", block.velocity, scene::Range{-100.0, 100.0});
        b.mayLack("velocity");
    });
    std::vector<scene::Emitter> emitters;
    from.list("emitters", emitters, [](scene::ObjectReader& e, scene::Emitter& emitter) { visitEmitter(e, emitter); });
    addEmitters(emitters, water);
    from.integer("from_frame", water.from_frame, 0, 1'000'000'000);
    from.integer("max_particles", water.max_particles, 0, 1'000'000);
    from.integer("depth_scale", water.depth_scale, 0, 8);
    from.number("depth_thickness", water.depth_thickness, scene::Range{0.0, 10.0});
    if (up == inject::Triple{}) {
        from.fail("up", "a direction", "[0, 0, 0]");
    } else if (up[0] != kAbsent) {
        water.up = up;
    }
}

}  // namespace

Status readInjectedScene(const std::string& path, inject::Settings& settings) {
    const Result<scene::Scene> loaded = scene::loadScene(path);
    if (!loaded) {
        return loaded.error();
    }
    const scene::Simulation& simulation = loaded.value().simulation;
    if (simulation.fluids.size() > 1) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path + ": /simulation/fluids",
                     fmt::format("expected one fluid to pour into a program, found {}", simulation.fluids.size()),
                     "leave one of them"};
    }
    inject::WaterPlan& water = settings.water;
    water.radius = simulation.radius;
    water.low = simulation.low;
    water.high = simulation.high;
    water.gravity = simulation.gravity;
    water.iterations = simulation.iterations;
    water.viscosity = simulation.viscosity;
    water.vorticity = simulation.vorticity;
    water.blocks.clear();
    for (const scene::FluidBox& box : simulation.fluid) {
        water.blocks.push_back({box.low, box.high, box.velocity});
    }
    addEmitters(simulation.emitters, water);
    settings.look = loaded.value().fluid;
    settings.sky = loaded.value().sky;
    return {};
}

Status readProfile(const std::string& path, inject::Settings& settings) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (!file) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, path, "cannot be read", "give the path of a profile"};
    }
    const Result<nlohmann::json> document = scene::parseObject(text, path, "docs/inject.md has the schema");
    if (!document) {
        return document.error();
    }
    std::optional<Error> failure;
    scene::ObjectReader profile(document.value(), "", path, failure);
    std::string program;
    profile.text("program", program);  // for people
    profile.number("start_deadline", settings.start_deadline, scene::Range{0.1, 600.0});
    readRule(profile, "overlay", settings.rules.overlay, kOverlays);
    profile.object("camera", [&](scene::ObjectReader& camera) { readCamera(camera, settings.rules); });
    profile.object("water", [&](scene::ObjectReader& water) { readWater(water, settings.water); });
    profile.finish();
    return failure ? Status{*failure} : Status{};
}

}  // namespace sluice::cli
