// SPDX-License-Identifier: MIT
#include "sluice/host_gl/engine.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <optional>

#include "engine/check_scene.hpp"
#include "engine/cloth.hpp"
#include "engine/colour.hpp"
#include "engine/display_list.hpp"
#include "engine/frame_state.hpp"
#include "engine/mesh.hpp"
#include "engine/moving_bodies.hpp"
#include "engine/paint.hpp"
#include "engine/scenery.hpp"
#include "engine/sky_dome.hpp"
#include "engine/texture.hpp"
#include "engine/triangle_mesh.hpp"
#include "screen/gl_guards.hpp"

namespace sluice::host {
namespace {

constexpr float kContactAlpha = 0.55F;
/// Below this sine of the sun's elevation shadows would be longer than the courtyard.
constexpr float kLowestSun = 0.05F;

/// Compared as bits, so that a NaN does not rebuild the dome in every frame.
auto bitsOf(const SluiceSky& sky) {
    return std::bit_cast<std::array<std::uint32_t, sizeof(SluiceSky) / sizeof(std::uint32_t)>>(sky);
}

/// Projects along the sun onto the plane y = height: p - to_sun (p.y - height) / to_sun.y, column-major.
std::array<float, 16> shadowMatrix(const SluiceSky& sky, float height) {
    const float a = sky.to_sun[0] / sky.to_sun[1];
    const float b = sky.to_sun[2] / sky.to_sun[1];
    return {1.0F, 0.0F, 0.0F, 0.0F, -a, 0.0F, -b, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, a * height, height, b * height, 1.0F};
}

}  // namespace

struct LegacyEngine::Impl {
    EngineScene scene;
    Texture paving, pool_floor, pool_wall, ashlar, limestone, shaft, arcade, crate, falloff;
    DisplayList ground, objects, contacts, casters, cube;
    // The dome depends on the sky, which a caller may change from frame to frame; kept while it does not.
    std::optional<SluiceSky> dome_sky;
    DisplayList dome;
    std::vector<Cloth> cloths;

    explicit Impl(EngineScene wanted);
    void drawSky(const SluiceCamera& camera, const SluiceSky& sky);
    void drawGround(const SluiceSky& sky, std::span<const MovingBody> bodies) const;
    void drawBodies(std::span<const MovingBody> bodies) const;
    void drawContacts() const;
};

LegacyEngine::Impl::Impl(EngineScene wanted) : scene(std::move(wanted)) {
    const NoiseField noise;
    paving = Texture(paintPaving(noise));
    pool_floor = Texture(paintPoolFloor(noise));
    pool_wall = Texture(paintPoolWall(noise));
    ashlar = Texture(paintAshlar(noise));
    limestone = Texture(paintLimestone(noise));
    shaft = Texture(paintShaft(noise));
    arcade = Texture(paintArcade(noise));
    crate = Texture(paintCrate(noise));
    falloff = Texture::alphaFalloff();

    ground = DisplayList([this] {
        paving.bind();
        emitPaving(scene);
        // The pool's floor lies in the plane of the paving: drawn over it as a decal that leaves depth alone.
        pool_floor.bind();
        glEnable(GL_POLYGON_OFFSET_FILL);
        glPolygonOffset(-1.0F, -1.0F);
        glDepthMask(GL_FALSE);
        emitPoolFloors(scene);
        glDepthMask(GL_TRUE);
        glDisable(GL_POLYGON_OFFSET_FILL);
    });
    objects = DisplayList([this] {
        pool_wall.bind();
        emitPoolWalls(scene);
        ashlar.bind();
        emitAshlar(scene);
        limestone.bind();
        emitLimestone(scene);
        for (const TriangleMesh& mesh : scene.meshes) {
            emitTriangles(mesh);
        }
        shaft.bind();
        emitShafts(scene);
        arcade.bind();
        emitEnclosure(scene);
        crate.bind();
        emitCrates(scene);
    });
    for (const Banner& banner : scene.banners) {
        cloths.emplace_back(banner);
    }
    contacts = DisplayList([this] { emitContacts(scene); });
    casters = DisplayList([this] {
        emitCasters(scene);
        for (const TriangleMesh& mesh : scene.meshes) {
            emitTriangles(mesh);
        }
    });
    cube = DisplayList(emitCube);
}

void LegacyEngine::Impl::drawSky(const SluiceCamera& camera, const SluiceSky& sky) {
    if (!dome_sky || bitsOf(*dome_sky) != bitsOf(sky)) {
        dome = DisplayList([&sky] { emitSkyDome(sky); });
        dome_sky = sky;
    }
    // Centred on the eye and anywhere between the planes: depth is neither tested nor written.
    std::array<float, 16> turn{};
    std::copy(std::begin(camera.view), std::end(camera.view), turn.begin());
    turn[12] = turn[13] = turn[14] = 0.0F;
    const float radius = 0.5F * (camera.near_plane + camera.far_plane);
    glMatrixMode(GL_MODELVIEW);
    glLoadMatrixf(turn.data());
    glScalef(radius, radius, radius);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_CULL_FACE);
    glDisable(GL_DEPTH_TEST);
    dome.call();
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glEnable(GL_TEXTURE_2D);
}

void LegacyEngine::Impl::drawGround(const SluiceSky& sky, std::span<const MovingBody> bodies) const {
    ground.call();
    GLint stencil_bits = 0;
    glGetIntegerv(GL_STENCIL_BITS, &stencil_bits);
    if (sky.to_sun[1] < kLowestSun || stencil_bits == 0) {
        return;
    }
    // Mark where the casters' projections cover the floor, then draw the floor again there without the sun.
    const auto matrix = shadowMatrix(sky, scene.floor_height);
    glPushAttrib(GL_ENABLE_BIT | GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT | GL_POLYGON_BIT);
    glDisable(GL_TEXTURE_2D);
    glDisable(GL_LIGHTING);
    glDisable(GL_FOG);
    glDisable(GL_CULL_FACE);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -4.0F);
    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_ALWAYS, 1, ~0U);
    glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
    glPushMatrix();
    glMultMatrixf(matrix.data());
    casters.call();
    drawBodies(bodies);
    glPopMatrix();
    glPopAttrib();

    glEnable(GL_STENCIL_TEST);
    glStencilFunc(GL_EQUAL, 1, ~0U);
    glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
    glDisable(GL_LIGHT0);
    ground.call();
    glEnable(GL_LIGHT0);
    glDisable(GL_STENCIL_TEST);
}

void LegacyEngine::Impl::drawBodies(std::span<const MovingBody> bodies) const {
    for (const MovingBody& body : bodies) {
        glPushMatrix();
        applyPose(body);
        if (body.box) {
            crate.bind();
            glScalef(2.0F * body.half[0], 2.0F * body.half[1], 2.0F * body.half[2]);
            cube.call();
        } else {
            limestone.bind();
            emitRound(body.half);
        }
        glPopMatrix();
    }
}

void LegacyEngine::Impl::drawContacts() const {
    glPushAttrib(GL_ENABLE_BIT | GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_POLYGON_BIT | GL_CURRENT_BIT);
    falloff.bind();
    glDisable(GL_LIGHTING);
    glDisable(GL_FOG);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1.0F, -4.0F);
    glColor4f(0.0F, 0.0F, 0.0F, kContactAlpha);
    contacts.call();
    glPopAttrib();
}

LegacyEngine::LegacyEngine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LegacyEngine::LegacyEngine(LegacyEngine&&) noexcept = default;
LegacyEngine& LegacyEngine::operator=(LegacyEngine&&) noexcept = default;
LegacyEngine::~LegacyEngine() = default;

Result<LegacyEngine> LegacyEngine::create(const EngineScene& scene) {
    if (auto status = checkScene(scene); !status.ok()) {
        return status.error();
    }
    clearGlErrors();
    auto impl = std::make_unique<Impl>(scene);
    if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
        return Error{error == GL_OUT_OF_MEMORY ? SLUICE_ERROR_OUT_OF_MEMORY : SLUICE_ERROR_INTERNAL,
                     "textures and display lists of the engine", fmt::format("GL error 0x{:04x}", error),
                     "is a GL context current?"};
    }
    return LegacyEngine(std::move(impl));
}

void LegacyEngine::draw(const SluiceCamera& camera, const SluiceSky& sky, std::span<const MovingBody> bodies) const {
    const FrameScope scope;
    setDefaults();
    const Vec3 clear = horizonColour(sky);
    glClearColor(clear[0], clear[1], clear[2], 1.0F);
    glClearDepth(1.0);
    glClearStencil(0);
    glDepthMask(GL_TRUE);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);

    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(&camera.projection[0]);
    impl_->drawSky(camera, sky);
    glLoadMatrixf(&camera.view[0]);
    setLights(sky, impl_->scene);
    setFog(sky, impl_->scene.fog_density);
    impl_->drawGround(sky, bodies);
    impl_->drawContacts();
    impl_->objects.call();
    impl_->drawBodies(bodies);
    for (const Cloth& cloth : impl_->cloths) {
        cloth.emit();
    }
}

void LegacyEngine::animate(float seconds) {
    for (Cloth& cloth : impl_->cloths) {
        cloth.step(seconds);
    }
}

}  // namespace sluice::host
