// SPDX-License-Identifier: MIT
#include "engine/frame_state.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <initializer_list>

namespace sluice::host {
namespace {

/// The sun's share of a surface that faces it, in the encoded values that this engine adds up. With the default ambient
/// a white surface just reaches 1; more would bleach the paving.
constexpr float kSunStrength = 0.78F;
/// Light from the open sky, from straight above: keeps shaded walls from looking flat.
constexpr float kSkyStrength = 0.16F;
/// Sunlight that the paving throws back, from below and from the side that the sun does not reach.
constexpr float kBounceStrength = 0.22F;

using Vec4 = std::array<float, 4>;

Vec4 opaque(const Vec3& c) {
    return {c[0], c[1], c[2], 1.0F};
}

/// Hue of the sun in encoded values; a radiance above 1 is as bright as this engine can show.
Vec3 sunColour(const SluiceSky& sky) {
    const float peak = std::max({1.0F, sky.sun_radiance[0], sky.sun_radiance[1], sky.sun_radiance[2]});
    return encodeSrgb({sky.sun_radiance[0] / peak, sky.sun_radiance[1] / peak, sky.sun_radiance[2] / peak});
}

}  // namespace

FrameScope::FrameScope() {
    glPushAttrib(GL_ALL_ATTRIB_BITS);
    glActiveTexture(GL_TEXTURE0);
    for (const GLenum mode : std::initializer_list<GLenum>{GL_TEXTURE, GL_PROJECTION, GL_MODELVIEW}) {
        glMatrixMode(mode);
        glPushMatrix();
    }
}

FrameScope::~FrameScope() {
    glActiveTexture(GL_TEXTURE0);
    for (const GLenum mode : std::initializer_list<GLenum>{GL_TEXTURE, GL_PROJECTION, GL_MODELVIEW}) {
        glMatrixMode(mode);
        glPopMatrix();
    }
    glPopAttrib();
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

}  // namespace sluice::host
