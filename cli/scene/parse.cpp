// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "fields.hpp"
#include "reader.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::scene {
namespace {

double length(const Vec3& v) {
    return std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

std::string shown(const Vec3& v) {
    return fmt::format("[{}, {}, {}]", v[0], v[1], v[2]);
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

void checkCamera(ObjectReader& reader, const CameraPath& camera) {
    if (camera.near_plane >= camera.far_plane) {
        reader.fail("camera/far", fmt::format("a number > near, which is {}", camera.near_plane),
                    fmt::format("{}", camera.far_plane));
    }
    const Vec3 forward{camera.target[0] - camera.position[0], camera.target[1] - camera.position[1],
                       camera.target[2] - camera.position[2]};
    if (length(forward) == 0.0) {
        reader.fail("camera/target", "a point other than position", shown(camera.target));
    }
    // Below one part in a million the cross product of the look-at has lost its direction in 32-bit floats.
    if (length(cross(forward, camera.up)) <= 1.0e-6 * length(forward) * length(camera.up)) {
        reader.fail("camera/up", "a direction that is not along the view", shown(camera.up));
    }
}

void normaliseSun(ObjectReader& reader, SluiceSky& sky) {
    const Vec3 to_sun{sky.to_sun[0], sky.to_sun[1], sky.to_sun[2]};
    const double norm = length(to_sun);
    if (norm < 1.0e-6) {
        reader.fail("sky/to_sun", "a direction of length > 0", shown(to_sun));
        return;
    }
    // A vector that is already unit to within rounding stays as it is, so that writing and reading are inverse.
    if (std::abs(norm - 1.0) > 4.0e-7) {
        for (float& component : sky.to_sun) {
            component = static_cast<float>(static_cast<double>(component) / norm);
        }
    }
}

void checkFrames(ObjectReader& reader, const FrameRange& frames) {
    if (frames.last < frames.first) {
        reader.fail("frames/1", fmt::format("a whole number >= the first frame, which is {}", frames.first),
                    fmt::format("{}", frames.last));
    }
}

/// A box whose low corner is below its high one, each way.
void checkBox(ObjectReader& reader, const std::string& key, const Vec3& low, const Vec3& high) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (low[axis] >= high[axis]) {
            reader.fail(fmt::format("{}/high/{}", key, axis), fmt::format("a number > low, which is {}", low[axis]),
                        fmt::format("{}", high[axis]));
        }
    }
}

bool overlap(const FluidBox& a, const FluidBox& b) {
    bool apart = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        apart = apart || a.high[axis] <= b.low[axis] || b.high[axis] <= a.low[axis];
    }
    return !apart;
}

void checkDirection(ObjectReader& reader, const std::string& key, const Vec3& direction) {
    if (length(direction) < 1.0e-6) {
        reader.fail(key, "a direction of length > 0", shown(direction));
    }
}

/// What a scene file alone can tell; the solver checks openings and rates against its radius.
void checkSources(ObjectReader& reader, const Simulation& s) {
    for (std::size_t i = 0; i < s.emitters.size(); ++i) {
        const Emitter& emitter = s.emitters[i];
        const std::string key = fmt::format("simulation/emitters/{}", i);
        checkDirection(reader, key + "/direction", emitter.direction);
        if (emitter.shape == kEmitterDisc && emitter.width != emitter.height) {
            reader.fail(key + "/height", fmt::format("the diameter of the disc, which is {}", emitter.width),
                        fmt::format("{}", emitter.height));
        }
        if (emitter.stop != 0.0F && emitter.stop <= emitter.start) {
            reader.fail(key + "/stop", fmt::format("0, or a time after start, which is {}", emitter.start),
                        fmt::format("{}", emitter.stop));
        }
    }
    for (std::size_t i = 0; i < s.drains.size(); ++i) {
        const Vec3& half = s.drains[i].half;
        if (s.drains[i].shape == kDrainSphere && (half[0] != half[1] || half[1] != half[2])) {
            reader.fail(fmt::format("simulation/drains/{}/half", i), "the radius of the sphere, three times",
                        shown(half));
        }
    }
    for (std::size_t i = 0; i < s.fields.size(); ++i) {
        checkDirection(reader, fmt::format("simulation/fields/{}/axis", i), s.fields[i].axis);
    }
}

void checkBodies(ObjectReader& reader, const Simulation& s) {
    for (std::size_t i = 0; i < s.bodies.size(); ++i) {
        const std::string key = fmt::format("simulation/bodies/{}", i);
        const Vec3& half = s.bodies[i].half;
        if (s.bodies[i].shape == kBodySphere && (half[0] != half[1] || half[1] != half[2])) {
            reader.fail(key + "/half", "the radius of the sphere, three times", shown(half));
        }
        if (s.bodies[i].shape == kBodyCapsule && (half[0] != half[2] || half[1] < half[0])) {
            reader.fail(key + "/half", "the radius of the capsule, its half length with the caps, its radius",
                        shown(half));
        }
        for (std::size_t k = 1; k < s.bodies[i].path.size(); ++k) {
            if (s.bodies[i].path[k].time <= s.bodies[i].path[k - 1].time) {
                reader.fail(fmt::format("{}/path/{}/time", key, k),
                            fmt::format("a time after {}", s.bodies[i].path[k - 1].time),
                            fmt::format("{}", s.bodies[i].path[k].time));
            }
        }
    }
}

void checkFluids(ObjectReader& reader, const Simulation& s) {
    const auto known = static_cast<std::uint32_t>(std::max<std::size_t>(s.fluids.size(), 1));
    const auto check = [&](const std::string& list, std::size_t i, std::uint32_t fluid) {
        if (fluid >= known) {
            reader.fail(fmt::format("simulation/{}/{}/fluid", list, i),
                        fmt::format("a place in simulation/fluids, which has {}", s.fluids.size()),
                        fmt::format("{}", fluid));
        }
    };
    for (std::size_t i = 0; i < s.fluid.size(); ++i) {
        check("fluid", i, s.fluid[i].fluid);
    }
    for (std::size_t i = 0; i < s.emitters.size(); ++i) {
        check("emitters", i, s.emitters[i].fluid);
    }
}

/// A body would go through what is only seen, and what is thinner than a particle does not hold.
void checkDepth(ObjectReader& reader, const Simulation& s) {
    if (s.collide != kCollideDepth) {
        return;
    }
    if (!s.bodies.empty()) {
        reader.fail("simulation/bodies", "none where \"collide\" is \"depth\": bodies do not meet what is seen",
                    fmt::format("{}", s.bodies.size()));
    }
    if (const float least = s.radius; s.depth.thickness != 0.0F && s.depth.thickness < least) {
        reader.fail("simulation/depth/thickness", fmt::format("0, or a number >= {}, which is a radius", least),
                    fmt::format("{}", s.depth.thickness));
    }
}

void checkSimulation(ObjectReader& reader, const Simulation& s) {
    checkDepth(reader, s);
    checkFluids(reader, s);
    checkBox(reader, "simulation/domain", s.low, s.high);
    checkSources(reader, s);
    checkBodies(reader, s);
    if (const float ratio = s.anisotropy.ratio; ratio != 0.0F && ratio < 1.0F) {
        reader.fail("simulation/anisotropy/ratio", "a number in [1, 10], or 0 for spheres", fmt::format("{}", ratio));
    }
    const auto above = [&](const char* high_key, float high, float low) {
        if (!(high > low)) {
            reader.fail(fmt::format("simulation/foam/{}", high_key),
                        fmt::format("a number > its low end, which is {}", low), fmt::format("{}", high));
        }
    };
    above("air_high", s.foam.air_high, s.foam.air_low);
    above("crest_high", s.foam.crest_high, s.foam.crest_low);
    above("energy_high", s.foam.energy_high, s.foam.energy_low);
    for (std::size_t i = 0; i < s.fluid.size(); ++i) {
        const std::string key = fmt::format("simulation/fluid/{}", i);
        checkBox(reader, key, s.fluid[i].low, s.fluid[i].high);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (s.fluid[i].low[axis] < s.low[axis] || s.fluid[i].high[axis] > s.high[axis]) {
                reader.fail(key, fmt::format("a box within the domain, {} to {}", shown(s.low), shown(s.high)),
                            fmt::format("{} to {}", shown(s.fluid[i].low), shown(s.fluid[i].high)));
            }
        }
        for (std::size_t other = 0; other < i; ++other) {
            if (overlap(s.fluid[i], s.fluid[other])) {
                reader.fail(key, fmt::format("a box that does not overlap fluid/{}", other),
                            fmt::format("{} to {}", shown(s.fluid[i].low), shown(s.fluid[i].high)));
            }
        }
    }
    for (std::size_t i = 0; i < s.planes.size(); ++i) {
        checkDirection(reader, fmt::format("simulation/planes/{}/normal", i), s.planes[i].normal);
    }
}

}  // namespace

Result<Scene> parseScene(std::string_view text, const std::string& name) {
    const Result<nlohmann::json> read = parseObject(text, name, "docs/cli.md has the schema");
    if (!read) {
        return read.error();
    }
    const nlohmann::json& document = read.value();
    Scene scene;
    std::optional<Error> failure;
    ObjectReader reader(document, "", name, failure);
    visitScene(reader, scene);
    reader.finish();
    checkCamera(reader, scene.camera);
    normaliseSun(reader, scene.sky);
    checkFrames(reader, scene.frames);
    checkSimulation(reader, scene.simulation);
    if (failure) {
        return *failure;
    }
    for (FluidKind& fluid : scene.simulation.fluids) {
        if (fluid.absorption[0] < 0.0F) {  // not given
            std::copy_n(std::begin(scene.fluid.absorption), 3, fluid.absorption.begin());
        }
    }
    return scene;
}

}  // namespace sluice::scene
