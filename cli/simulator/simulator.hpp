// SPDX-License-Identifier: MIT
// A fluid that is simulated on the first Vulkan device that can, without OpenGL and without a plugin.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sluice/result.hpp"

namespace sluice::vk {
struct DepthField;
struct DistanceGrid;
}  // namespace sluice::vk

namespace sluice::simulator {

using Vec3 = std::array<float, 3>;

struct Sphere {
    Vec3 centre;
    float radius;
};
struct Capsule {
    Vec3 from, to;
    float radius;
};
struct Box {
    Vec3 centre, half;
    float turn_degrees;  ///< about +y
};
struct Plane {
    Vec3 normal, through;
};

/// In the world; counter-clockwise as seen from outside.
struct Mesh {
    std::string name;  ///< for messages
    std::vector<std::array<double, 3>> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Where particles are born, die and are blown; as the solver's own sources.hpp has them.
struct Emitter {
    bool disc;
    Vec3 centre, direction;
    float width, height, speed, rate, start, stop;
    std::uint32_t fluid = 0;
};
struct Drain {
    bool sphere;
    Vec3 centre, half;
};
struct ForceField {
    enum class Kind : std::uint8_t { Wind, Point, Vortex } kind;
    Vec3 centre, axis;
    float strength, radius;
};

struct PathPoint {
    float time;
    Vec3 centre;
    float turn_degrees;
};
struct Body {
    enum class Shape : std::uint8_t { Sphere, Capsule, Box } shape;
    Vec3 centre, half;
    float turn_degrees, density;
    Vec3 velocity, spin;
    std::vector<PathPoint> path;
};
/// A body after the last step; force and torque are the fluid's in it, N and N m.
struct BodyPose {
    Vec3 centre;
    std::array<float, 4> turn;  ///< unit quaternion from its axes to the world's
    Vec3 velocity, spin, force, torque;
};

/// One of several.
struct Fluid {
    float density, viscosity, tension, adhesion;
};

/// What density is measured with.
enum class Kernel : std::uint8_t { Poly6, Spline, Wendland };

/// docs/simulation.md has every number; metres and seconds.
struct Setup {
    float radius = 0.02F;
    Vec3 low{}, high{}, gravity{};
    std::uint32_t iterations = 4;
    Kernel kernel = Kernel::Poly6;
    float relaxation = 0.0F, tensile = 0.0F, viscosity = 0.0F, vorticity = 0.0F, cfl = 0.0F, tension = 0.0F,
          adhesion = 0.0F, overshoot = 0.0F;
    std::vector<Fluid> fluids;  ///< none: water, with the viscosity, tension and adhesion above
    std::vector<Sphere> spheres;
    std::vector<Capsule> capsules;
    std::vector<Box> boxes;
    std::vector<Plane> planes;
    std::shared_ptr<const vk::DistanceGrid> meshes;  ///< of addMeshes; may be none
    std::shared_ptr<const vk::DepthField> seen;      ///< of seenDepth; may be none
    std::vector<Emitter> emitters;
    std::vector<Drain> drains;
    std::vector<ForceField> fields;
    std::vector<Body> bodies;
    std::uint32_t most_particles = 0;  ///< at which emitters stop
};

/// Particles in the order in which they were given; triples.
struct Particles {
    std::vector<float> position, velocity;
    std::vector<std::uint32_t> fluid;  ///< of each, which of the setup's; empty where that has none
};

/// What it took to get from one time to another.
struct Advance {
    std::uint32_t steps = 0, split = 0;  ///< split: steps taken again in halves
    double shortest = 0.0;               ///< step, seconds
    double speed = 0.0;                  ///< greatest, m/s
    std::uint32_t most_neighbours = 0;
    double mean_compression = 0.0;  ///< mean of max(density - 1, 0) after the last step, in densities of rest
    double greatest_density = 0.0;
    std::uint64_t born = 0, blocked = 0, drained = 0;  ///< particles
    bool stopped = false;                              ///< before its time; then compression and density are not known
};

/// What Simulator::create would refuse of it on any device; the error's thing is "simulation: WHAT[ NUMBER][: FIELD]".
[[nodiscard]] Status check(const Setup& setup);

/// The fastest that anything may be, m/s, for Simulator::advance to get so many seconds further.
[[nodiscard]] double fastestAllowed(const Setup& setup, double seconds);
/// The fastest point of a body, m/s: its speed and its spin, or the fastest leg of its path.
[[nodiscard]] double fastestOfBody(const Setup& setup, std::size_t body);

/// Makes the meshes solids of a setup whose radius and domain are final. Refused, with the mesh named, unless each is a
/// closed surface.
[[nodiscard]] Status addMeshes(Setup& setup, std::span<const Mesh> meshes);

/// Of which camera, column-major, and how large.
struct SeenImage {
    std::array<float, 16> view, projection;
    float near_plane;
    std::uint32_t width, height;
};
/// What an image of depths, bottom row first, is as a solid: the nearest of each `scale` times `scale` of them, on a
/// surface so thick (0: a radius). Refused, with the reason, if it cannot be one.
[[nodiscard]] Result<std::shared_ptr<const vk::DepthField>> seenDepth(const SeenImage& image,
                                                                      const std::vector<float>& depth,
                                                                      std::uint32_t scale, float thickness,
                                                                      float radius);

/// The most particles that a fluid of `at_start` particles has within so many seconds: with every birth of its
/// emitters.
[[nodiscard]] double mostParticles(const Setup& setup, std::size_t at_start, double seconds);

/// Distance from each position (triples) to the nearest solid, body or face of the domain, metres; negative where no
/// fluid may be. What is seen is none of these: it moves out by itself who begins in it.
[[nodiscard]] std::vector<double> clearances(const Setup& setup, const std::vector<float>& positions);

/// The device and the solver on it. Errors of create: INVALID_ARGUMENT when the setup is wrong, else the device's.
class Simulator {
  public:
    static Result<Simulator> create(const Setup& setup, bool validation);
    Simulator(Simulator&&) noexcept;
    Simulator& operator=(Simulator&&) noexcept;
    ~Simulator();

    /// In place of the setup's, which there must have been.
    [[nodiscard]] Status setDepth(const vk::DepthField& seen);
    [[nodiscard]] Status setParticles(const Particles& particles);
    /// On an error the particles are those of the last good step. `stop` is asked after every step, and ends it.
    [[nodiscard]] Result<Advance> advance(double seconds, double longest, const std::function<bool()>& stop);
    [[nodiscard]] Result<Particles> read() const;
    /// In the order of the setup.
    [[nodiscard]] std::vector<BodyPose> bodies() const;
    [[nodiscard]] std::string device() const;
    [[nodiscard]] std::uint32_t validationMessages() const;
    /// Milliseconds of each pass so far.
    [[nodiscard]] std::vector<std::pair<std::string, double>> times() const;

  private:
    struct State;
    explicit Simulator(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace sluice::simulator
