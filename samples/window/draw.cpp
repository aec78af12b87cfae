// SPDX-License-Identifier: MIT
#include "draw.hpp"

#include <SDL_opengl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <vector>

#include "world.hpp"

namespace window {
namespace {

constexpr int kTexels = 64;
constexpr float kTextureMetres = 0.5F;  // that one repetition covers

/// 0 to 1, the same for the same numbers.
float speckle(int x, int y) {
    auto hash = static_cast<std::uint32_t>(x) * 0x9e3779b9U ^ static_cast<std::uint32_t>(y) * 0x85ebca6bU;
    hash = (hash ^ (hash >> 15U)) * 0x2c1b3c6dU;
    return static_cast<float>((hash ^ (hash >> 12U)) & 0xffffU) / 65535.0F;
}

GLuint texture(const std::function<float(int, int)>& brightness) {
    std::vector<std::uint8_t> texels;
    for (int y = 0; y < kTexels; ++y) {
        for (int x = 0; x < kTexels; ++x) {
            texels.push_back(static_cast<std::uint8_t>(std::clamp(brightness(x, y), 0.0F, 1.0F) * 255.0F));
        }
    }
    GLuint name = 0;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexParameteri(GL_TEXTURE_2D, GL_GENERATE_MIPMAP, GL_TRUE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_LUMINANCE, kTexels, kTexels, 0, GL_LUMINANCE, GL_UNSIGNED_BYTE, texels.data());
    return name;
}

/// Flags with joints between them.
float stone(int x, int y) {
    const int row = y / 32;
    const bool joint = y % 32 < 2 || (x + 16 * row) % 32 < 2;
    return joint ? 0.55F : 0.82F + 0.15F * speckle(x / 2, y / 2) - 0.08F * speckle(row, (x + 16 * row) / 32);
}

/// Planks with their grain.
float wood(int x, int y) {
    const bool joint = x % 16 < 1;
    return joint ? 0.35F : 0.75F + 0.2F * speckle(x, y / 16) + 0.05F * std::sin(0.4F * static_cast<float>(y + x));
}

struct Face {
    glm::vec3 normal, across, up;
};
constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                      {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                      {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                      {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                      {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                      {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};

float lengthAlong(glm::vec3 axis, glm::vec3 half) {
    return std::abs(axis.x) * half.x + std::abs(axis.y) * half.y + std::abs(axis.z) * half.z;
}

void drawBox(const Box& box) {
    glPushMatrix();
    glTranslatef(box.centre.x, box.centre.y, box.centre.z);
    glRotatef(box.turn, 0.0F, 1.0F, 0.0F);
    glColor3fv(glm::value_ptr(box.colour));
    glBegin(GL_QUADS);
    for (const Face& face : kFaces) {
        const float wide = lengthAlong(face.across, box.half);
        const float high = lengthAlong(face.up, box.half);
        glNormal3fv(glm::value_ptr(face.normal));
        for (const auto& [a, b] : {std::pair{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}}) {
            const glm::vec3 corner = face.normal * box.half + a * wide * face.across + b * high * face.up;
            glTexCoord2f(a * wide / kTextureMetres, b * high / kTextureMetres);
            glVertex3fv(glm::value_ptr(corner));
        }
    }
    glEnd();
    glPopMatrix();
}

void drawFloor() {
    constexpr float kReach = 8.0F;
    constexpr float kTile = 0.5F;  // lit by its corners, so it must not be one polygon
    glNormal3f(0.0F, 1.0F, 0.0F);
    glColor3f(0.62F, 0.66F, 0.62F);
    for (float z = -kReach; z < kReach; z += kTile) {
        glBegin(GL_QUAD_STRIP);
        for (float x = -kReach; x <= kReach; x += kTile) {
            for (const float edge : {z, z + kTile}) {
                glTexCoord2f(x / kTextureMetres, edge / kTextureMetres);
                glVertex3f(x, 0.0F, edge);
            }
        }
        glEnd();
    }
}

/// As a monitor takes it.
std::array<float, 3> encoded(const float (&linear)[3]) {
    std::array<float, 3> out{};
    std::transform(std::begin(linear), std::end(linear), out.begin(),
                   [](float v) { return std::pow(std::clamp(v, 0.0F, 1.0F), 1.0F / 2.2F); });
    return out;
}

void drawBackground(const SluiceSky& sky) {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_LIGHTING);
    glDisable(GL_TEXTURE_2D);
    glBegin(GL_QUADS);
    glColor3fv(encoded(sky.horizon).data());
    glVertex2f(-1.0F, -1.0F);
    glVertex2f(1.0F, -1.0F);
    glColor3fv(encoded(sky.zenith).data());
    glVertex2f(1.0F, 1.0F);
    glVertex2f(-1.0F, 1.0F);
    glEnd();
    glEnable(GL_DEPTH_TEST);
}

void light(const SluiceSky& sky) {
    const std::array<float, 4> sun{sky.to_sun[0], sky.to_sun[1], sky.to_sun[2], 0.0F};
    const std::array<float, 4> ambient{0.38F, 0.42F, 0.48F, 1.0F};
    const std::array<float, 4> diffuse{0.75F, 0.7F, 0.6F, 1.0F};
    glLightfv(GL_LIGHT0, GL_POSITION, sun.data());
    glLightfv(GL_LIGHT0, GL_AMBIENT, ambient.data());
    glLightfv(GL_LIGHT0, GL_DIFFUSE, diffuse.data());
    glEnable(GL_LIGHT0);
    glEnable(GL_LIGHTING);
    glEnable(GL_COLOR_MATERIAL);
}

}  // namespace

WorldPainter::WorldPainter(const SluiceSky& sky) : sky_(sky), stone_(texture(stone)), wood_(texture(wood)) {
    list_ = glGenLists(1);
    glNewList(list_, GL_COMPILE);
    glEnable(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, stone_);
    drawFloor();
    for (const Box& box : boxes()) {
        glBindTexture(GL_TEXTURE_2D, box.surface == Surface::Wood ? wood_ : stone_);
        if (box.surface == Surface::Paint) {
            glDisable(GL_TEXTURE_2D);
        }
        drawBox(box);
        glEnable(GL_TEXTURE_2D);
    }
    glDisable(GL_TEXTURE_2D);
    glEndList();
}

WorldPainter::~WorldPainter() {
    glDeleteLists(list_, 1);
    glDeleteTextures(1, &stone_);
    glDeleteTextures(1, &wood_);
}

void WorldPainter::draw(const Orbit& orbit, glm::ivec2 size) const {
    glViewport(0, 0, size.x, size.y);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glMatrixMode(GL_MODELVIEW);
    glLoadIdentity();
    drawBackground(sky_);
    glMatrixMode(GL_PROJECTION);
    glLoadMatrixf(glm::value_ptr(projectionOf(size)));
    glMatrixMode(GL_MODELVIEW);
    glLoadMatrixf(glm::value_ptr(viewOf(orbit)));
    glEnable(GL_CULL_FACE);
    light(sky_);
    glCallList(list_);
    glDisable(GL_LIGHTING);
    glDisable(GL_CULL_FACE);
}

}  // namespace window
