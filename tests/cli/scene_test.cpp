// SPDX-License-Identifier: MIT
#include "sluice/scene/scene.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>

namespace sluice::scene {
namespace {

TEST(SceneFile, AnEmptyObjectIsTheDefaults) {
    const Result<Scene> scene = parseScene("{}", "s.json");
    ASSERT_TRUE(scene.ok());
    EXPECT_EQ(writeScene(scene.value()), writeScene(Scene{}));
    EXPECT_EQ(scene.value().camera.position, (Vec3{-4, 4, -3}));
    EXPECT_EQ(scene.value().camera.vertical_fov_degrees, 58.3F);
    EXPECT_EQ(scene.value().size, (Size{1280, 720}));
    EXPECT_EQ(scene.value().fluid.filter, std::uint32_t{SLUICE_FILTER_NARROW_RANGE});
    EXPECT_EQ(scene.value().fluid.refraction, 1U);
}

TEST(SceneFile, ATapMayLeaveOutWhatZeroMeans) {
    const Result<Scene> read = parseScene(R"({"simulation": {"emitters": [{"shape": "disc", "centre": [0, 1, 0],
        "direction": [0, -1, 0], "width": 0.2, "height": 0.2, "speed": 1}]}})",
                                          "s.json");
    ASSERT_TRUE(read.ok()) << read.error().message();
    const Emitter& tap = read.value().simulation.emitters.at(0);
    EXPECT_EQ(tap.rate, 0.0F);
    EXPECT_EQ(tap.start, 0.0F);
    EXPECT_EQ(tap.stop, 0.0F);
}

TEST(SceneFile, EveryKeyIsRead) {
    const Result<Scene> read = parseScene(R"({
        // comments are allowed
        "particles": {"path": "f_####.ply", "radius": 0.5, "transform": {"scale": 2, "translate": [1, 2, 3]}},
        "camera": {"position": [1, 2, 3], "target": [4, 5, 7], "up": [0, 0, 1], "vertical_fov_degrees": 30, "near": 0.5,
                   "far": 9, "orbit_degrees_per_frame": -2},
        "sky": {"to_sun": [0, 3, 4], "zenith": [1, 2, 3]},
        "environment": "e.exr",
        "fluid": {"absorption": [7, 8, 9], "filter": "none", "thickness_scale": 0.25, "view": "normal",
                  "refraction": false},
        "engine": {"pillars": [{"base": [1, 0, 2], "radius": 0.25, "height": 3}],
                   "basins": [{"centre": [0, 1, 0], "half_x": 1, "half_z": 2, "height": 3, "wall": 4}]},
        "simulation": {"radius": 0.05, "domain": {"low": [-2, 0, -2], "high": [2, 3, 2]}, "gravity": [0, -1, 0],
                       "frames_per_second": 60, "steps_per_frame": 2, "iterations": 7, "kernel": "spline", "viscosity": 0.5, "tension": 1.5, "adhesion": 2,
                       "collide_with_engine": false,
                       "fluid": [{"low": [0, 0, 0], "high": [1, 1, 1], "velocity": [0, 0, 4]}],
                       "spheres": [{"centre": [1, 2, 3], "radius": 0.5}],
                       "capsules": [{"from": [1, 2, 3], "to": [4, 5, 6], "radius": 0.25}],
                       "boxes": [{"centre": [1, 2, 3], "half": [1, 2, 3], "turn_degrees": 30}],
                       "planes": [{"normal": [0, 1, 0], "through": [0, -1, 0]}],
                       "meshes": [{"path": "m.obj", "position": [1, 2, 3], "turn_degrees": 30, "scale": 0.5}],
                       "emitters": [{"shape": "box", "centre": [0, 1, 0], "direction": [0, -1, 1], "width": 0.1, "height": 0.2,
                                     "speed": 2, "rate": 0, "start": 0.5, "stop": 3}],
                       "drains": [{"shape": "sphere", "centre": [1, 0, 1], "half": [0.5, 0.5, 0.5]}],
                       "fields": [{"kind": "vortex", "centre": [0, 1, 0], "axis": [0, 1, 0], "strength": -4,
                                   "radius": 2}],
                       "bodies": [{"shape": "capsule", "centre": [0, 1, 0], "half": [0.1, 0.3, 0.1], "turn_degrees": 5,
                                   "density": 0.5, "velocity": [1, 0, 0], "spin": [0, 1, 0],
                                   "path": [{"time": 0, "centre": [0, 1, 0], "turn_degrees": 0},
                                            {"time": 2, "centre": [1, 1, 0], "turn_degrees": 90}]}]},
        "frames": [3, 8], "size": [64, 48]})",
                                          "s.json");
    ASSERT_TRUE(read.ok()) << read.error().message();
    const Scene& s = read.value();
    EXPECT_EQ(s.particles.path, "f_####.ply");
    EXPECT_EQ(s.particles.scale, 2.0F);
    EXPECT_EQ(s.particles.translate, (Vec3{1, 2, 3}));
    EXPECT_EQ(s.camera.up, (Vec3{0, 0, 1}));
    EXPECT_EQ(s.camera.orbit_degrees_per_frame, -2.0F);
    EXPECT_FLOAT_EQ(s.sky.to_sun[1], 0.6F);
    EXPECT_FLOAT_EQ(s.sky.to_sun[2], 0.8F);
    EXPECT_EQ(s.environment, "e.exr");
    EXPECT_EQ(s.fluid.absorption[2], 9.0F);
    EXPECT_EQ(s.fluid.thickness_scale, 0.25F);
    EXPECT_EQ(s.fluid.view, std::uint32_t{SLUICE_VIEW_NORMAL});
    EXPECT_EQ(s.fluid.refraction, 0U);
    EXPECT_EQ(s.fluid.reflection, 1U);
    ASSERT_EQ(s.engine.pillars.size(), 1U);
    EXPECT_EQ(s.engine.pillars[0].height, 3.0F);
    ASSERT_EQ(s.engine.basins.size(), 1U);
    EXPECT_EQ(s.engine.basins[0].half_z, 2.0F);
    EXPECT_EQ(s.simulation.high, (Vec3{2, 3, 2}));
    EXPECT_EQ(s.simulation.iterations, 7U);
    EXPECT_EQ(s.simulation.kernel, uint32_t{SLUICE_KERNEL_SPLINE});
    EXPECT_EQ(s.simulation.steps_per_frame, 2U);
    EXPECT_EQ(s.simulation.frames_per_second, 60.0F);
    EXPECT_EQ(s.simulation.viscosity, 0.5F);
    EXPECT_EQ(s.simulation.tension, 1.5F);
    EXPECT_EQ(s.simulation.adhesion, 2.0F);
    EXPECT_EQ(s.simulation.collide_with_engine, 0U);
    ASSERT_EQ(s.simulation.fluid.size(), 1U);
    EXPECT_EQ(s.simulation.fluid[0].velocity, (Vec3{0, 0, 4}));
    ASSERT_EQ(s.simulation.capsules.size(), 1U);
    EXPECT_EQ(s.simulation.capsules[0].to, (Vec3{4, 5, 6}));
    ASSERT_EQ(s.simulation.boxes.size(), 1U);
    EXPECT_EQ(s.simulation.boxes[0].turn_degrees, 30.0F);
    ASSERT_EQ(s.simulation.meshes.size(), 1U);
    EXPECT_EQ(s.simulation.meshes[0].path, "m.obj");
    EXPECT_EQ(s.simulation.meshes[0].scale, 0.5F);
    ASSERT_EQ(s.simulation.emitters.size(), 1U);
    EXPECT_EQ(s.simulation.emitters[0].shape, kEmitterBox);
    EXPECT_EQ(s.simulation.emitters[0].stop, 3.0F);
    ASSERT_EQ(s.simulation.drains.size(), 1U);
    EXPECT_EQ(s.simulation.drains[0].shape, kDrainSphere);
    ASSERT_EQ(s.simulation.fields.size(), 1U);
    EXPECT_EQ(s.simulation.fields[0].kind, kFieldVortex);
    EXPECT_EQ(s.simulation.fields[0].strength, -4.0F);
    ASSERT_EQ(s.simulation.bodies.size(), 1U);
    EXPECT_EQ(s.simulation.bodies[0].shape, kBodyCapsule);
    ASSERT_EQ(s.simulation.bodies[0].path.size(), 2U);
    EXPECT_EQ(s.simulation.bodies[0].path[1].turn_degrees, 90.0F);
    EXPECT_EQ(writeScene(parseScene(writeScene(s), "again").value()), writeScene(s));
    EXPECT_EQ(s.frames, (FrameRange{3, 8}));
    EXPECT_EQ(s.size, (Size{64, 48}));
}

/// Thousandths, so that counter-examples read well.
float thousandths(int low, int high) {
    return static_cast<float>(*rc::gen::inRange(low, high)) / 1000.0F;
}
Vec3 vector(int low, int high) {
    return {thousandths(low, high), thousandths(low, high), thousandths(low, high)};
}

RC_GTEST_PROP(SceneFile, WritingAndReadingAreInverse, ()) {
    Scene scene;
    scene.particles.path = *rc::gen::string<std::string>();
    std::erase_if(scene.particles.path, [](char c) { return c < ' ' || c > '~'; });
    scene.particles.scale = thousandths(1, 100'000);
    scene.particles.translate = vector(-9000, 9000);
    scene.camera.position = vector(-9000, -1000);
    scene.camera.target = vector(0, 9000);
    scene.camera.near_plane = thousandths(1, 1000);
    scene.camera.far_plane = thousandths(2000, 900'000);
    for (float& c : scene.fluid.absorption) {
        c = thousandths(0, 100'000);
    }
    scene.fluid.filter = *rc::gen::inRange(0U, 2U);
    scene.fluid.filter_iterations = *rc::gen::inRange(0U, 17U);
    scene.fluid.thickness_scale = *rc::gen::element(1.0F, 0.5F, 0.25F);
    scene.fluid.view = *rc::gen::inRange(0U, 5U);
    scene.fluid.reflection = *rc::gen::inRange(0U, 2U);
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
        scene.engine.pillars.push_back({vector(-9000, 9000), thousandths(1, 900), thousandths(1, 9000)});
        scene.engine.crates.push_back({vector(-9000, 9000), thousandths(1, 900), thousandths(-9000, 9000)});
    }
    if (*rc::gen::inRange(0, 2) == 1) {
        scene.engine.banners.push_back(
            {vector(-9000, 0), vector(1, 9000), thousandths(1, 900), *rc::gen::inRange(1U, 257U), 4});
    }
    scene.frames.first = *rc::gen::inRange(0, 100);
    scene.frames.last = scene.frames.first + *rc::gen::inRange(0, 100);
    scene.size = {*rc::gen::inRange(1U, 16385U), *rc::gen::inRange(1U, 16385U)};
    RC_PRE(scene.camera.target != scene.camera.position);
    const std::string text = writeScene(scene);
    const Result<Scene> read = parseScene(text, "s.json");
    if (!read.ok()) {
        RC_FAIL(read.error().message());
    }
    RC_ASSERT(writeScene(read.value()) == text);
    RC_ASSERT(read.value().camera.position == scene.camera.position);
    RC_ASSERT(read.value().fluid.absorption[1] == scene.fluid.absorption[1]);
}

RC_GTEST_PROP(SceneFile, NoTextIsAFault, (const std::string& text)) {
    const Result<Scene> scene = parseScene(text, "s.json");
    RC_ASSERT(scene.ok() || !scene.error().detail.empty());
}

TEST(SceneCamera, MapsTheTargetToTheMiddleAndPlanesToTheirDepths) {
    Scene scene;
    const SluiceCamera camera = cameraAt(scene, 1, {1280, 720});
    const auto eye = [&](const Vec3& p, int row) {
        auto sum = static_cast<double>(camera.view[12 + row]);
        for (int c = 0; c < 3; ++c) {
            sum += static_cast<double>(camera.view[4 * c + row]) * static_cast<double>(p[static_cast<std::size_t>(c)]);
        }
        return sum;
    };
    EXPECT_NEAR(eye(scene.camera.target, 0), 0.0, 1e-5);
    EXPECT_NEAR(eye(scene.camera.target, 1), 0.0, 1e-5);
    EXPECT_NEAR(eye(scene.camera.target, 2), -std::sqrt(16.0 + 9.0 + 9.0), 1e-5);
    const auto ndc_z = [&](double z) {
        return (static_cast<double>(camera.projection[10]) * z + static_cast<double>(camera.projection[14])) / -z;
    };
    EXPECT_NEAR(ndc_z(-static_cast<double>(camera.near_plane)), -1.0, 1e-5);
    EXPECT_NEAR(ndc_z(-static_cast<double>(camera.far_plane)), 1.0, 1e-5);
    EXPECT_NEAR(static_cast<double>(camera.projection[5]), 1.0 / std::tan(58.3 * 3.14159265358979 / 360.0), 1e-5);
    EXPECT_NEAR(static_cast<double>(camera.projection[5] / camera.projection[0]), 1280.0 / 720.0, 1e-5);
}

TEST(SceneCamera, AFullOrbitComesBack) {
    Scene scene;
    scene.frames = {1, 73};
    scene.camera.orbit_degrees_per_frame = 5.0F;
    const SluiceCamera first = cameraAt(scene, 1, scene.size);
    const SluiceCamera half = cameraAt(scene, 37, scene.size);
    const SluiceCamera last = cameraAt(scene, 73, scene.size);
    for (int i = 0; i < 16; ++i) {
        EXPECT_NEAR(first.view[i], last.view[i], 1e-6F);
    }
    EXPECT_NEAR(first.view[0], -half.view[0], 1e-6F);
}

TEST(SceneFile, EverySampleParses) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SLUICE_SAMPLES)) {
        if (entry.path().extension() == ".json") {
            const Result<Scene> scene = loadScene(entry.path());
            EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message());
            ++count;
        }
    }
    EXPECT_GE(count, 3);
}

}  // namespace
}  // namespace sluice::scene
