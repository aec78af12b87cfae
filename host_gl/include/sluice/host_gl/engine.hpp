// SPDX-License-Identifier: MIT
// The legacy engine: a small fixed-function scene in the manner of 2004.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "sluice/plugin.h"
#include "sluice/result.hpp"

namespace sluice::host {

using Vec3 = std::array<float, 3>;

/// A round column with plinth and capital; metres.
struct Pillar {
    Vec3 base;
    float radius;
    float height;
};
/// A wooden cube, turned about +y.
struct Crate {
    Vec3 centre;
    float size;
    float turn_degrees;
};
/// Four stone walls around an open rectangle, standing on `floor`; inner half extents in x and z.
struct Basin {
    Vec3 centre;
    float half_x, half_z, height, wall;
};

/// Something that is elsewhere in every frame: a wooden box, or a ball or capsule of stone.
struct MovingBody {
    bool box;                   ///< or round, upright along its own y axis
    Vec3 centre;                ///< metres
    Vec3 half;                  ///< of the box about it along its own axes; a round one's radius, half length, radius
    std::array<float, 4> turn;  ///< unit quaternion (x, y, z, w) from its axes to the world's
};

/// A square-woven cloth that hangs from a line and moves in the wind: the engine's own physics, stepped on its thread.
/// A step costs about cells^2 * iterations.
inline constexpr std::uint32_t kMostBannerCells = 256;
struct Banner {
    Vec3 from, to;
    float drop;
    std::uint32_t cells;       ///< threads each way
    std::uint32_t iterations;  ///< of the relaxation, a step
};

/// A surface of stone, counter-clockwise as seen from outside; edges sharper than 40 degrees are drawn as edges.
struct TriangleMesh {
    std::vector<Vec3> corners;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What stands in the scene. Lengths in metres, +y up.
struct EngineScene {
    float floor_height = 0.0F;
    float floor_half_extent = 12.0F;
    float fog_density = 0.02F;  ///< GL_EXP2
    std::vector<Pillar> pillars;
    std::vector<Crate> crates;
    std::vector<Basin> basins;
    std::vector<Banner> banners;
    std::vector<TriangleMesh> meshes;
    /// Added to every lit surface, in sRGB-encoded values as the engine works in them.
    Vec3 ambient{0.35F, 0.37F, 0.42F};
    float enclosure_height = 3.0F;  ///< of the arcaded wall around the floor's edge; 0 leaves it out
};

/// Draws with display lists, fixed-function lighting and fog, procedural textures and a sky dome, into whatever
/// framebuffer is bound. All GL names are freed on destruction, with the context current.
class LegacyEngine {
  public:
    [[nodiscard]] static Result<LegacyEngine> create(const EngineScene& scene);
    LegacyEngine(LegacyEngine&&) noexcept;
    LegacyEngine& operator=(LegacyEngine&&) noexcept;
    ~LegacyEngine();

    /// One step of what moves by itself: the banners. Plain work of the calling thread; no GL.
    void animate(float seconds);

    /// Clears colour, depth and stencil and draws one frame. Leaves all other state as it found it (needs one free
    /// level of the attribute and matrix stacks). Fixed-function state is set, but no program, sampler or vertex array
    /// may be bound, as in an engine that predates them. The sun's hue lights the scene; a sun_radiance above 1 is as
    /// bright as this engine can show. Shadows fall on the floor only, and only if the framebuffer has a stencil.
    void draw(const SluiceCamera& camera, const SluiceSky& sky, std::span<const MovingBody> bodies = {}) const;

  private:
    struct Impl;
    explicit LegacyEngine(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace sluice::host
