// SPDX-License-Identifier: MIT
#include "sluice/host_gl/engine.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <optional>

#include "engine/colour.hpp"
#include "engine/display_list.hpp"
#include "engine/paint.hpp"
#include "engine/scenery.hpp"
#include "engine/sky_dome.hpp"
#include "engine/texture.hpp"
#include "screen/gl_guards.hpp"

namespace sluice::host {
namespace {

/// The sun's share of a surface that faces it, in the encoded values that this engine adds up. With the default ambient
/// a white surface just reaches 1; more would bleach the paving.
constexpr float kSunStrength = 0.78F;
/// Light from the open sky, from straight above: keeps shaded walls from looking flat.
constexpr float kSkyStrength = 0.16F;
/// Sunlight that the paving throws back, from below and from the side that the sun does not reach.
constexpr float kBounceStrength = 0.22F;
constexpr float kContactAlpha = 0.55F;
/// Below this sine of the sun's elevation shadows would be longer than the courtyard.
constexpr float kLowestSun = 0.05F;

using Vec4 = std::array<float, 4>;

/// Compared as bits, so that a NaN does not rebuild the dome in every frame.
auto bitsOf(const SluiceSky& sky) {
    return std::bit_cast<std::array<std::uint32_t, sizeof(SluiceSky) / sizeof(std::uint32_t)>>(sky);
}

Vec4 opaque(const Vec3& c) {
    return {c[0], c[1], c[2], 1.0F};
}

/// Hue of the sun in encoded values; a radiance above 1 is as bright as this engine can show.
Vec3 sunColour(const SluiceSky& sky) {
    const float peak = std::max({1.0F, sky.sun_radiance[0], sky.sun_radiance[1], sky.sun_radiance[2]});
    return encodeSrgb({sky.sun_radiance[0] / peak, sky.sun_radiance[1] / peak, sky.sun_radiance[2] / peak});
}

Vec3 horizonColour(const SluiceSky& sky) {
    return encodeSrgb({sky.horizon[0], sky.horizon[1], sky.horizon[2]});
}

void setLights(const SluiceSky& sky, const EngineScene& scene) {
    const Vec4 none{0.0F, 0.0F, 0.0F, 1.0F};
    const Vec4 ambient = opaque(scene.ambient);
    const Vec4 sun = opaque(sunColour(sky) * kSunStrength);
    const Vec4 to_sun{sky.to_sun[0], sky.to_sun[1], sky.to_sun[2], 0.0F};
    const Vec4 overhead{0.0F, 1.0F, 0.0F, 0.0F};
    const Vec4 bounce = opaque(sunColour(sky) * kBounceStrength);
    const Vec4 dome = opaque(encodeSrgb({sky.zenith[0], sky.zenith[1], sky.zenith[2]}) * kSkyStrength);
    glLightModelfv(GL_LIGHT_MODEL_AMBIENT, ambient.data());
    glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, GL_FALSE);
    glLightModeli(GL_LIGHT_MODEL_LOCAL_VIEWER, GL_FALSE);
    glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, GL_SINGLE_COLOR);
    for (GLenum light = GL_LIGHT3; light <= GL_LIGHT7; ++light) {
        glDisable(light);
    }
    const auto set = [&](GLenum light, const Vec4& diffuse, const Vec4& direction) {
        glLightfv(light, GL_AMBIENT, none.data());
        glLightfv(light, GL_DIFFUSE, diffuse.data());
        glLightfv(light, GL_SPECULAR, none.data());
        glLightfv(light, GL_POSITION, direction.data());
        glLightf(light, GL_SPOT_CUTOFF, 180.0F);
        glEnable(light);
    };
    set(GL_LIGHT0, sun, to_sun);
    set(GL_LIGHT1, dome, overhead);
    set(GL_LIGHT2, bounce, {-sky.to_sun[0], -0.4F, -sky.to_sun[2], 0.0F});
    glMaterialfv(GL_FRONT_AND_BACK, GL_SPECULAR, none.data());
    glMaterialfv(GL_FRONT_AND_BACK, GL_EMISSION, none.data());
    glColorMaterial(GL_FRONT_AND_BACK, GL_AMBIENT_AND_DIFFUSE);
    glEnable(GL_COLOR_MATERIAL);
    glEnable(GL_LIGHTING);
    glEnable(GL_NORMALIZE);  // crates are scaled
}

void setFog(const SluiceSky& sky, float density) {
    const Vec4 colour = opaque(horizonColour(sky));
    glFogi(GL_FOG_MODE, GL_EXP2);
    glFogf(GL_FOG_DENSITY, density);
    glFogfv(GL_FOG_COLOR, colour.data());
    glHint(GL_FOG_HINT, GL_NICEST);
    if (density > 0.0F) {
        glEnable(GL_FOG);
    }
}

/// Everything that the frame relies on, whatever state the caller was in.
void setDefaults() {
    for (const GLenum off : std::initializer_list<GLenum>{
             GL_SCISSOR_TEST, GL_BLEND, GL_ALPHA_TEST, GL_STENCIL_TEST, GL_COLOR_LOGIC_OP, GL_FOG, GL_LIGHTING,
             GL_DITHER, GL_POLYGON_OFFSET_FILL, GL_POLYGON_STIPPLE, GL_POLYGON_SMOOTH, GL_COLOR_SUM, GL_CLIP_PLANE0,
             GL_CLIP_PLANE1, GL_CLIP_PLANE2, GL_CLIP_PLANE3, GL_CLIP_PLANE4, GL_CLIP_PLANE5}) {
        glDisable(off);
    }
    glActiveTexture(GL_TEXTURE0);
    glMatrixMode(GL_TEXTURE);
    glLoadIdentity();
    for (const GLenum off :
         std::initializer_list<GLenum>{GL_TEXTURE_GEN_S, GL_TEXTURE_GEN_T, GL_TEXTURE_GEN_R, GL_TEXTURE_GEN_Q,
                                       GL_TEXTURE_1D, GL_TEXTURE_3D, GL_TEXTURE_CUBE_MAP}) {
        glDisable(off);
    }
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_MODULATE);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glStencilMask(~0U);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glFrontFace(GL_CCW);
    glCullFace(GL_BACK);
    glShadeModel(GL_SMOOTH);
    glDepthFunc(GL_LEQUAL);
    glDepthRange(0.0, 1.0);
}

/// Projects along the sun onto the plane y = height: p - to_sun (p.y - height) / to_sun.y, column-major.
std::array<float, 16> shadowMatrix(const SluiceSky& sky, float height) {
    const float a = sky.to_sun[0] / sky.to_sun[1];
    const float b = sky.to_sun[2] / sky.to_sun[1];
    return {1.0F, 0.0F, 0.0F, 0.0F, -a, 0.0F, -b, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, a * height, height, b * height, 1.0F};
}

/// One level of every matrix stack that the frame writes, and of the attribute stack.
class FrameScope {
  public:
    FrameScope() {
        glPushAttrib(GL_ALL_ATTRIB_BITS);
        glActiveTexture(GL_TEXTURE0);
        for (const GLenum mode : std::initializer_list<GLenum>{GL_TEXTURE, GL_PROJECTION, GL_MODELVIEW}) {
            glMatrixMode(mode);
            glPushMatrix();
        }
    }
    FrameScope(const FrameScope&) = delete;
    FrameScope& operator=(const FrameScope&) = delete;
    ~FrameScope() {
        glActiveTexture(GL_TEXTURE0);
        for (const GLenum mode : std::initializer_list<GLenum>{GL_TEXTURE, GL_PROJECTION, GL_MODELVIEW}) {
            glMatrixMode(mode);
            glPopMatrix();
        }
        glPopAttrib();
    }
};

Status checkScene(const EngineScene& scene) {
    const auto bad = [](std::string thing, std::string detail) {
        return Error{SLUICE_ERROR_INVALID_ARGUMENT, std::move(thing), std::move(detail), "correct the scene"};
    };
    if (!(scene.floor_half_extent > 0.0F) || !std::isfinite(scene.floor_half_extent)) {
        return bad("floor half extent", fmt::format("{} m, must be positive", scene.floor_half_extent));
    }
    if (!(scene.fog_density >= 0.0F)) {
        return bad("fog density", fmt::format("{} per metre, must not be negative", scene.fog_density));
    }
    for (std::size_t i = 0; i < scene.pillars.size(); ++i) {
        const Pillar& p = scene.pillars[i];
        if (!(p.radius > 0.0F) || !(p.height > 0.0F)) {
            return bad(fmt::format("pillar {}", i),
                       fmt::format("radius {} m and height {} m must be positive", p.radius, p.height));
        }
    }
    for (std::size_t i = 0; i < scene.crates.size(); ++i) {
        if (!(scene.crates[i].size > 0.0F)) {
            return bad(fmt::format("crate {}", i), fmt::format("size {} m, must be positive", scene.crates[i].size));
        }
    }
    for (std::size_t i = 0; i < scene.basins.size(); ++i) {
        const Basin& b = scene.basins[i];
        if (!(b.half_x > 0.0F) || !(b.half_z > 0.0F) || !(b.height > 0.0F) || !(b.wall > 0.0F)) {
            return bad(fmt::format("basin {}", i),
                       fmt::format("half extents {} and {} m, height {} m and wall {} m must be positive", b.half_x,
                                   b.half_z, b.height, b.wall));
        }
    }
    return {};
}

}  // namespace

struct LegacyEngine::Impl {
    EngineScene scene;
    Texture paving, pool_floor, pool_wall, ashlar, limestone, shaft, arcade, crate, falloff;
    DisplayList ground, objects, contacts, casters;
    // The dome depends on the sky, which a caller may change from frame to frame; kept while it does not.
    std::optional<SluiceSky> dome_sky;
    DisplayList dome;

    explicit Impl(EngineScene wanted);
    void drawSky(const SluiceCamera& camera, const SluiceSky& sky);
    void drawGround(const SluiceSky& sky) const;
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
        shaft.bind();
        emitShafts(scene);
        arcade.bind();
        emitEnclosure(scene);
        crate.bind();
        emitCrates(scene);
    });
    contacts = DisplayList([this] { emitContacts(scene); });
    casters = DisplayList([this] { emitCasters(scene); });
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

void LegacyEngine::Impl::drawGround(const SluiceSky& sky) const {
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

void LegacyEngine::draw(const SluiceCamera& camera, const SluiceSky& sky) const {
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
    impl_->drawGround(sky);
    impl_->drawContacts();
    impl_->objects.call();
}

}  // namespace sluice::host
