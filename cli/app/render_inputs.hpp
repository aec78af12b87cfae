// SPDX-License-Identifier: MIT
// Everything that a render reads, checked before anything is drawn or written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "app/live_fluid.hpp"
#include "app/options.hpp"
#include "image/environment.hpp"
#include "sluice/particles/particles.hpp"
#include "sluice/result.hpp"
#include "sluice/scene/scene.hpp"

namespace sluice::cli {

struct LoadedParticles {
    std::filesystem::path path;
    particles::ParticleSet set;  ///< in world space
};

struct RenderInputs {
    std::string scene_file;  ///< for messages
    scene::Scene scene;      ///< it names particles, or `live` has some
    scene::FrameRange frames;
    scene::Size size;
    std::optional<Environment> environment;
    /// The particles of the first frame, kept from the check so that they are not read twice; the frame takes them.
    std::optional<LoadedParticles> first;
    std::vector<host::MovingBody> bodies;  ///< of the frame in hand
    std::optional<LiveFluid> live;         ///< in the place of particle files
};

/// The scene with the command line's overrides. Reads the scene file and its meshes only. A scene without particles
/// whose simulation has no fluid either is an error.
[[nodiscard]] Result<RenderInputs> readScene(const RenderOptions& options);

/// Reads the environment map and every particle file once, so that a bad file is found before the first output. Warns
/// of a radius that is not the first file's own. Draws a progress bar if `progress`. Ends early, with success, when
/// interrupted() (interrupt.hpp).
[[nodiscard]] Status checkInputs(RenderInputs& inputs, bool progress);

/// The file of `frame`.
[[nodiscard]] Result<std::filesystem::path> particlePath(const scene::ParticleSource& source, std::int64_t frame);

/// Reads a particle file into world space.
[[nodiscard]] Result<particles::ParticleSet> loadParticles(const scene::ParticleSource& source,
                                                           const std::filesystem::path& path);

/// One line of warning if `set`, read from `path`, has the radius of the scene because the file holds none.
void warnOfRadius(const std::string& scene_file, const scene::ParticleSource& source, const particles::ParticleSet& set,
                  const std::filesystem::path& path);

/// world = scale * file + translate, radius and velocity scaled.
void transform(particles::ParticleSet& set, const scene::ParticleSource& source);

/// The ABI's view of `set`, which must outlive it.
[[nodiscard]] SluiceParticles particleView(const particles::ParticleSet& set);

}  // namespace sluice::cli
