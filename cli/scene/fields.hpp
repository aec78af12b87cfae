// SPDX-License-Identifier: MIT
// Every key of a scene file, said once: the reader and the writer are both visitors of these functions.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include "limits.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::scene {

using Choice = std::pair<std::string_view, std::uint32_t>;

inline constexpr std::array<Choice, 2> kFilters{
    {{"none", SLUICE_FILTER_NONE}, {"narrow_range", SLUICE_FILTER_NARROW_RANGE}}};
inline constexpr std::array<Choice, 5> kViews{{{"fluid", SLUICE_VIEW_FLUID},
                                               {"depth", SLUICE_VIEW_DEPTH},
                                               {"normal", SLUICE_VIEW_NORMAL},
                                               {"thickness", SLUICE_VIEW_THICKNESS},
                                               {"echo", SLUICE_VIEW_ECHO}}};

inline constexpr std::array<Choice, 2> kCollides{{{"solids", kCollideSolids}, {"depth", kCollideDepth}}};
inline constexpr std::array<Choice, 3> kKernels{
    {{"poly6", SLUICE_KERNEL_POLY6}, {"spline", SLUICE_KERNEL_SPLINE}, {"wendland", SLUICE_KERNEL_WENDLAND}}};
inline constexpr std::array<Choice, 2> kEmitterShapes{{{"disc", kEmitterDisc}, {"box", kEmitterBox}}};
inline constexpr std::array<Choice, 2> kDrainShapes{{{"sphere", kDrainSphere}, {"box", kDrainBox}}};
inline constexpr std::array<Choice, 3> kBodyShapes{
    {{"sphere", kBodySphere}, {"capsule", kBodyCapsule}, {"box", kBodyBox}}};
inline constexpr std::array<Choice, 3> kFieldKinds{
    {{"wind", kFieldWind}, {"point", kFieldPoint}, {"vortex", kFieldVortex}}};

template <typename Visitor>
void visitParticles(Visitor& v, ParticleSource& p) {
    v.text("path", p.path);
    v.number("radius", p.radius, kLength);
    v.object("transform", [&p](auto& t) {
        t.number("scale", p.scale, kPositiveLength);
        t.numbers("translate", p.translate, kAnyLength);
    });
}

template <typename Visitor>
void visitCamera(Visitor& v, CameraPath& c) {
    v.numbers("position", c.position, kAnyLength);
    v.numbers("target", c.target, kAnyLength);
    v.numbers("up", c.up, kAnyLength);
    v.number("vertical_fov_degrees", c.vertical_fov_degrees, Range{1.0, 170.0});
    v.number("near", c.near_plane, kPositiveLength);
    v.number("far", c.far_plane, kPositiveLength);
    v.number("orbit_degrees_per_frame", c.orbit_degrees_per_frame, kDegrees);
}

template <typename Visitor>
void visitSky(Visitor& v, SluiceSky& s) {
    v.numbers("zenith", s.zenith, kLight);
    v.numbers("horizon", s.horizon, kLight);
    v.numbers("ground", s.ground, kLight);
    v.numbers("to_sun", s.to_sun, Range{-kWorld, kWorld});
    v.numbers("sun_radiance", s.sun_radiance, kLight);
}

template <typename Visitor>
void visitFluid(Visitor& v, SluiceFluid& f) {
    v.numbers("absorption", f.absorption, kAbsorption);
    v.numbers("scatter_colour", f.scatter_colour, kLight);
    v.number("index_of_refraction", f.index_of_refraction, Range{1.0, 4.0, true});
    v.number("specular_power", f.specular_power, Range{1.0, 1.0e5});
    v.number("splat_radius", f.splat_radius, Range{0.1, 10.0});
    v.choice("filter", f.filter, kFilters);
    v.integer("filter_iterations", f.filter_iterations, 0, 16);
    v.number("filter_range", f.filter_range, Range{0.0, 1000.0, true});
    v.number("filter_clamp", f.filter_clamp, Range{0.0, 1000.0, true});
    v.number("filter_sigma", f.filter_sigma, Range{0.0, 100.0, true});
    v.integer("filter_max_pixels", f.filter_max_pixels, 1, 128);
    v.numberOf("thickness_scale", f.thickness_scale, std::array{1.0F, 0.5F, 0.25F});
    v.number("thickness_blur", f.thickness_blur, Range{0.0, 100.0});
    v.flag("refraction", f.refraction);
    v.flag("reflection", f.reflection);
    v.flag("ellipsoids", f.ellipsoids);
    v.number("foam", f.foam, Range{0.0, 1000.0});
    v.choice("view", f.view, kViews);
}

template <typename Visitor>
void visitEngine(Visitor& v, host::EngineScene& e) {
    v.number("floor_height", e.floor_height, kAnyLength);
    v.number("floor_half_extent", e.floor_half_extent, kPositiveLength);
    v.number("fog_density", e.fog_density, Range{0.0, 10.0});
    v.numbers("ambient", e.ambient, kUnit);
    v.list("pillars", e.pillars, [](auto& p, host::Pillar& pillar) {
        p.numbers("base", pillar.base, kAnyLength);
        p.number("radius", pillar.radius, kPositiveLength);
        p.number("height", pillar.height, kPositiveLength);
    });
    v.list("crates", e.crates, [](auto& c, host::Crate& crate) {
        c.numbers("centre", crate.centre, kAnyLength);
        c.number("size", crate.size, kPositiveLength);
        c.number("turn_degrees", crate.turn_degrees, kDegrees);
    });
    v.list("banners", e.banners, [](auto& b, host::Banner& banner) {
        b.numbers("from", banner.from, kAnyLength);
        b.numbers("to", banner.to, kAnyLength);
        b.number("drop", banner.drop, kPositiveLength);
        b.integer("cells", banner.cells, 1, host::kMostBannerCells);
        b.integer("iterations", banner.iterations, 1, 1000);
    });
    v.list("basins", e.basins, [](auto& b, host::Basin& basin) {
        b.numbers("centre", basin.centre, kAnyLength);
        b.number("half_x", basin.half_x, kPositiveLength);
        b.number("half_z", basin.half_z, kPositiveLength);
        b.number("height", basin.height, kPositiveLength);
        b.number("wall", basin.wall, kPositiveLength);
    });
}

template <typename Visitor>
void visitEmitter(Visitor& v, Emitter& e) {
    v.choice("shape", e.shape, kEmitterShapes);
    v.numbers("centre", e.centre, kAnyLength);
    v.numbers("direction", e.direction, Range{-kWorld, kWorld});
    v.number("width", e.width, kPositiveLength);
    v.number("height", e.height, kPositiveLength);
    v.number("speed", e.speed, Range{0.0, 1.0e4, true});
    v.number("rate", e.rate, Range{0.0, 1.0e9});
    v.number("start", e.start, Range{0.0, 1.0e6});
    v.number("stop", e.stop, Range{0.0, 1.0e6});
    for (const char* has_default : {"rate", "start", "stop"}) {
        v.mayLack(has_default);
    }
}

template <typename Visitor>
void visitSources(Visitor& v, Simulation& s) {
    v.list("emitters", s.emitters, [](auto& o, Emitter& emitter) {
        visitEmitter(o, emitter);
        o.integer("fluid", emitter.fluid, 0, kMostFluids - 1);
        o.mayLack("fluid");
    });
    v.list("drains", s.drains, [](auto& o, Drain& drain) {
        o.choice("shape", drain.shape, kDrainShapes);
        o.numbers("centre", drain.centre, kAnyLength);
        o.numbers("half", drain.half, kPositiveLength);
    });
    v.list("fields", s.fields, [](auto& o, ForceField& field) {
        o.choice("kind", field.kind, kFieldKinds);
        o.numbers("centre", field.centre, kAnyLength);
        o.numbers("axis", field.axis, Range{-kWorld, kWorld});
        o.number("strength", field.strength, Range{-1.0e4, 1.0e4});
        o.number("radius", field.radius, kLength);
    });
}

template <typename Visitor>
void visitBodies(Visitor& v, Simulation& s) {
    v.list("bodies", s.bodies, [](auto& o, MovingBody& body) {
        o.choice("shape", body.shape, kBodyShapes);
        o.numbers("centre", body.centre, kAnyLength);
        o.numbers("half", body.half, kPositiveLength);
        o.number("turn_degrees", body.turn_degrees, kDegrees);
        o.number("density", body.density, Range{0.001, 1000.0});
        o.numbers("velocity", body.velocity, Range{-1.0e4, 1.0e4});
        o.numbers("spin", body.spin, Range{-1.0e4, 1.0e4});
        o.list("path", body.path, [](auto& p, PathPoint& point) {
            p.number("time", point.time, Range{0.0, 1.0e6});
            p.numbers("centre", point.centre, kAnyLength);
            p.number("turn_degrees", point.turn_degrees, kDegrees);
        });
    });
}

template <typename Visitor>
void visitSimulation(Visitor& v, Simulation& s) {
    v.number("radius", s.radius, Range{1.0e-4, 100.0});
    v.object("domain", [&s](auto& d) {
        d.numbers("low", s.low, kAnyLength);
        d.numbers("high", s.high, kAnyLength);
    });
    v.numbers("gravity", s.gravity, Range{-1.0e4, 1.0e4});
    v.number("frames_per_second", s.frames_per_second, Range{1.0, 1.0e4});
    v.integer("steps_per_frame", s.steps_per_frame, 1, 1000);
    v.integer("iterations", s.iterations, 1, 64);
    v.choice("kernel", s.kernel, kKernels);
    v.number("relaxation", s.relaxation, Range{1.0e-6, 1000.0});
    v.number("tensile", s.tensile, kUnit);
    v.number("viscosity", s.viscosity, kUnit);
    v.number("vorticity", s.vorticity, Range{0.0, 100.0});
    v.number("tension", s.tension, Range{0.0, 100.0});
    v.number("adhesion", s.adhesion, Range{0.0, 100.0});
    v.number("cfl", s.cfl, Range{0.01, 0.5});
    v.number("overshoot", s.overshoot, Range{0.0, 1.0});
    v.object("anisotropy", [&s](auto& o) {
        o.number("ratio", s.anisotropy.ratio, Range{0.0, 10.0});
        o.number("smoothing", s.anisotropy.smoothing, kUnit);
        o.number("lonely", s.anisotropy.lonely, Range{0.0, 1.0, true});
    });
    v.object("foam", [&s](auto& o) {
        o.number("life", s.foam.life, Range{0.0, 1.0e6});
        o.number("air_low", s.foam.air_low, Range{0.0, 1.0e6});
        o.number("air_high", s.foam.air_high, Range{0.0, 1.0e6});
        o.number("crest_low", s.foam.crest_low, Range{0.0, 1.0e6});
        o.number("crest_high", s.foam.crest_high, Range{0.0, 1.0e6});
        o.number("energy_low", s.foam.energy_low, Range{0.0, 1.0e6});
        o.number("energy_high", s.foam.energy_high, Range{0.0, 1.0e6});
    });
    v.number("jitter", s.jitter, Range{0.0, 0.5});
    v.flag("collide_with_engine", s.collide_with_engine);
    v.text("start", s.start);
    v.choice("collide", s.collide, kCollides);
    v.object("depth", [&s](auto& d) {
        d.text("path", s.depth.path);
        d.number("thickness", s.depth.thickness, kLength);
        d.integer("scale", s.depth.scale, 1, 8);
    });
    v.list("fluid", s.fluid, [](auto& o, FluidBox& box) {
        o.numbers("low", box.low, kAnyLength);
        o.numbers("high", box.high, kAnyLength);
        o.numbers("velocity", box.velocity, Range{-1.0e4, 1.0e4});
        o.integer("fluid", box.fluid, 0, kMostFluids - 1);
        o.mayLack("fluid");
        o.mayLack("velocity");
    });
    v.list("fluids", s.fluids, [](auto& o, FluidKind& fluid) {
        o.number("density", fluid.density, Range{0.001, 1000.0});
        o.number("viscosity", fluid.viscosity, kUnit);
        o.number("tension", fluid.tension, Range{0.0, 100.0});
        o.number("adhesion", fluid.adhesion, Range{0.0, 100.0});
        o.numbers("colour", fluid.colour, kUnit);
        o.numbers("absorption", fluid.absorption, kAbsorption);
        o.mayLack("absorption");
    });
    v.list("spheres", s.spheres, [](auto& o, SolidSphere& sphere) {
        o.numbers("centre", sphere.centre, kAnyLength);
        o.number("radius", sphere.radius, kPositiveLength);
    });
    v.list("capsules", s.capsules, [](auto& o, SolidCapsule& capsule) {
        o.numbers("from", capsule.from, kAnyLength);
        o.numbers("to", capsule.to, kAnyLength);
        o.number("radius", capsule.radius, kPositiveLength);
    });
    v.list("boxes", s.boxes, [](auto& o, SolidBox& box) {
        o.numbers("centre", box.centre, kAnyLength);
        o.numbers("half", box.half, kPositiveLength);
        o.number("turn_degrees", box.turn_degrees, kDegrees);
    });
    v.list("planes", s.planes, [](auto& o, SolidPlane& plane) {
        o.numbers("normal", plane.normal, Range{-kWorld, kWorld});
        o.numbers("through", plane.through, kAnyLength);
    });
    v.list("meshes", s.meshes, [](auto& o, SolidMesh& mesh) {
        o.text("path", mesh.path);
        o.numbers("position", mesh.position, kAnyLength);
        o.number("turn_degrees", mesh.turn_degrees, kDegrees);
        o.number("scale", mesh.scale, kPositiveLength);
    });
    visitSources(v, s);
    visitBodies(v, s);
}

template <typename Visitor>
void visitScene(Visitor& v, Scene& s) {
    v.object("particles", [&s](auto& o) { visitParticles(o, s.particles); });
    v.object("camera", [&s](auto& o) { visitCamera(o, s.camera); });
    v.object("sky", [&s](auto& o) { visitSky(o, s.sky); });
    v.text("environment", s.environment);
    v.object("fluid", [&s](auto& o) { visitFluid(o, s.fluid); });
    v.object("engine", [&s](auto& o) { visitEngine(o, s.engine); });
    v.object("simulation", [&s](auto& o) { visitSimulation(o, s.simulation); });
    v.pair("frames", s.frames.first, s.frames.last, 0, kMaxFrame);
    v.pair("size", s.size.width, s.size.height, 1, kMaxSize);
}

}  // namespace sluice::scene
