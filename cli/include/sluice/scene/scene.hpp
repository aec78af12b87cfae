// SPDX-License-Identifier: MIT
// A scene: which particles, seen from where, in which light and in which engine scene. docs/cli.md has the JSON schema.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sluice/host_gl/engine.hpp"
#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::scene {

using Vec3 = std::array<float, 3>;

/// Frames first..last, both included.
struct FrameRange {
    std::int64_t first = 1, last = 1;
    [[nodiscard]] std::int64_t count() const { return last - first + 1; }
    bool operator==(const FrameRange&) const = default;
};

/// Picture size in pixels.
struct Size {
    std::uint32_t width = 1280, height = 720;
    bool operator==(const Size&) const = default;
};

/// Largest width or height, as SluiceCreateInfo has it.
inline constexpr std::uint32_t kMaxSize = SLUICE_MAX_EXTENT;
inline constexpr std::int64_t kMaxFrame = 1'000'000'000;

/// A particle file or numbered sequence; world position = scale * file position + translate.
struct ParticleSource {
    std::string path;     ///< pattern ("pool_####.pos") or one file; resolved against the scene file; empty: none given
    float radius = 0.0F;  ///< metres, before scaling, for files that carry none; 0: such a file is an error
    float scale = 1.0F;   ///< scales the radius too
    Vec3 translate{};     ///< metres
};

/// The camera of every frame. Orbit turns position about the vertical axis through target.
struct CameraPath {
    Vec3 position{-4.0F, 4.0F, -3.0F};
    Vec3 target{0.0F, 1.0F, 0.0F};
    Vec3 up{0.0F, 1.0F, 0.0F};
    float vertical_fov_degrees = 58.3F;
    float near_plane = 0.1F, far_plane = 60.0F;  ///< metres
    float orbit_degrees_per_frame = 0.0F;        ///< counted from the scene's first frame
};

/// The one place where the fluid's default look is written down.
[[nodiscard]] SluiceFluid defaultFluid();
/// The default daylight. to_sun is unit.
[[nodiscard]] SluiceSky defaultSky();

/// A box that is full of particles at the start.
struct FluidBox {
    Vec3 low, high;           ///< metres
    Vec3 velocity;            ///< m/s
    std::uint32_t fluid = 0;  ///< which of the list
};
/// One of several fluids in a simulation.
struct FluidKind {
    float density;  ///< at rest, of water
    float viscosity;
    float tension, adhesion;      ///< m/s^2
    Vec3 colour;                  ///< linear RGB, of its particles in files that have colours
    Vec3 absorption{-1, -1, -1};  ///< per metre; below 0 only until the scene has been read: as Scene::fluid has it
};
inline constexpr std::uint32_t kMostFluids = 8;
struct SolidSphere {
    Vec3 centre;
    float radius;
};
/// Everything within radius of the line between two points.
struct SolidCapsule {
    Vec3 from, to;
    float radius;
};
/// Turned about +y, as host::Crate is.
struct SolidBox {
    Vec3 centre, half;
    float turn_degrees;
};
/// Everything on the side that the normal points away from; it need not be unit.
struct SolidPlane {
    Vec3 normal, through;
};

/// A closed surface of triangles from a file.
struct SolidMesh {
    std::string path;    ///< OBJ, resolved against the scene file
    Vec3 position;       ///< of the file's origin
    float turn_degrees;  ///< about +y, after scaling
    float scale;
};

/// A nozzle. docs/simulation.md says where its particles leave it, and when.
struct Emitter {
    std::uint32_t shape = 0;  ///< kEmitterDisc, kEmitterBox
    Vec3 centre, direction;
    float width, height;      ///< metres; a disc's diameter, twice
    float speed;              ///< m/s
    float rate;               ///< particles per second; 0: as many as there is room for
    float start, stop;        ///< s; stop 0: never
    std::uint32_t fluid = 0;  ///< which of the list
};
inline constexpr std::uint32_t kEmitterDisc = 0, kEmitterBox = 1;
/// What takes the particles that come into it.
struct Drain {
    std::uint32_t shape = 0;  ///< kDrainSphere, kDrainBox
    Vec3 centre, half;        ///< of a sphere all three are its radius
};
inline constexpr std::uint32_t kDrainSphere = 0, kDrainBox = 1;
/// An acceleration, m/s^2.
struct ForceField {
    std::uint32_t kind = 0;  ///< kFieldWind, kFieldPoint, kFieldVortex
    Vec3 centre, axis;
    float strength;
    float radius;  ///< 0: everywhere the same
};
inline constexpr std::uint32_t kFieldWind = 0, kFieldPoint = 1, kFieldVortex = 2;

/// Where a body that goes its own way is at one time.
struct PathPoint {
    float time;  ///< s
    Vec3 centre;
    float turn_degrees;  ///< about +y
};
/// A body that the fluid pushes, or that goes along its path.
struct MovingBody {
    std::uint32_t shape = 0;  ///< kBodySphere, kBodyCapsule, kBodyBox
    Vec3 centre, half;  ///< of the box about it: a sphere's radius three times, a capsule's radius, half length, radius
    float turn_degrees;   ///< about +y
    float density;        ///< of water at rest
    Vec3 velocity, spin;  ///< m/s, rad/s
    std::vector<PathPoint> path;
};
inline constexpr std::uint32_t kBodySphere = 0, kBodyCapsule = 1, kBodyBox = 2;

/// What the scene's camera sees, as a solid.
struct SeenDepth {
    std::string path;         ///< of `sluice simulate`: an image of depths, one file or a numbered sequence, resolved
                              ///< against the scene file
    float thickness = 0.0F;   ///< metres; 0: eight particle radii
    std::uint32_t scale = 1;  ///< pixels each way of which the nearest is kept
};
inline constexpr std::uint32_t kCollideSolids = 0, kCollideDepth = 1;

/// What `sluice simulate` makes particles of. docs/simulation.md has the formulas. Frame 1 is time 0.
/// Ellipsoids of a simulation's particles while frames are drawn.
struct Anisotropy {
    float ratio = 0.0F;      ///< greatest of the longest axis to the shortest; 0: particles are spheres
    float smoothing = 0.0F;  ///< how far a centre goes to its neighbours' mean
    float lonely = 0.5F;     ///< size of a particle without neighbours
};

/// Where its water turns white meanwhile. Pairs: from where a potential counts, and from where it is 1.
struct Foam {
    float life = 0.0F;  ///< s after which half of it is left; 0: none
    float air_low = 5.0F, air_high = 20.0F, crest_low = 2.0F, crest_high = 8.0F, energy_low = 5.0F, energy_high = 50.0F;
};

struct Simulation {
    float radius = 0.02F;                ///< of a particle, metres
    Vec3 low{-1, 0, -1}, high{1, 2, 1};  ///< the box that nothing leaves
    Vec3 gravity{0, -9.81F, 0};          ///< m/s^2
    float frames_per_second = 30.0F;
    std::uint32_t steps_per_frame = 8;  ///< at least; fast fluid takes more; 4 let deep fluid gain energy
    std::uint32_t iterations = 4;
    std::uint32_t kernel = SLUICE_KERNEL_POLY6;  ///< SluiceDensityKernel
    float relaxation = 0.1F, tensile = 0.0005F, viscosity = 0.02F, vorticity = 0.0F, cfl = 0.4F, overshoot = 0.17F;
    float tension = 0.0F, adhesion = 0.0F;  ///< m/s^2
    Anisotropy anisotropy;
    Foam foam;
    float jitter = 0.05F;                    ///< radii that a particle may be off its lattice at the start
    std::uint32_t collide_with_engine = 1;   ///< floor, pillars, crates and basins are solids too
    std::uint32_t collide = kCollideSolids;  ///< kCollideDepth: not those, nor meshes, but what is seen of them
    SeenDepth depth;
    std::string start;  ///< particle file that the fluid begins with, resolved like a mesh's; empty: none
    std::vector<FluidBox> fluid;
    std::vector<FluidKind> fluids;  ///< none: water, with the viscosity, tension and adhesion above
    std::vector<SolidSphere> spheres;
    std::vector<SolidCapsule> capsules;
    std::vector<SolidBox> boxes;
    std::vector<SolidPlane> planes;
    std::vector<SolidMesh> meshes;
    std::vector<Emitter> emitters;
    std::vector<Drain> drains;
    std::vector<ForceField> fields;
    std::vector<MovingBody> bodies;
};

struct Scene {
    ParticleSource particles;
    CameraPath camera;
    SluiceSky sky = defaultSky();
    std::string environment;  ///< latitude-longitude image, resolved against the scene file; empty: the procedural sky
    SluiceFluid fluid = defaultFluid();
    host::EngineScene engine;
    Simulation simulation;
    FrameRange frames;
    Size size;
};

/// Pure. Reads JSON (comments allowed). An unknown key, a wrong type or a value out of range is an error that names the
/// JSON pointer, the value, what was expected and, for a key, the nearest known one. `name` is used in messages.
/// Paths are kept as written. Code of errors: SLUICE_ERROR_INVALID_ARGUMENT.
[[nodiscard]] Result<Scene> parseScene(std::string_view text, const std::string& name);

/// Every field as JSON; parseScene gives the same scene back.
[[nodiscard]] std::string writeScene(const Scene& scene);

/// Reads the file and resolves its relative paths against the folder that holds it.
[[nodiscard]] Result<Scene> loadScene(const std::filesystem::path& path);

/// The camera of `frame` for pictures of that size: right-handed look-at, symmetric OpenGL perspective.
[[nodiscard]] SluiceCamera cameraAt(const Scene& scene, std::int64_t frame, Size size);

}  // namespace sluice::scene
