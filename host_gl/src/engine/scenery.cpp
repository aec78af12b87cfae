// SPDX-License-Identifier: MIT
#include "engine/scenery.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/mesh.hpp"
#include "engine/paint.hpp"

namespace sluice::host {
namespace {

constexpr float kCopingHeight = 0.07F;    // metres
constexpr float kCopingOverhang = 0.04F;  // metres, outwards only: the inner face stays where the fluid's walls are
constexpr int kPillarSegments = 40;       // sagitta 0.5 mm at a radius of 0.16 m
constexpr int kCasterSegments = 16;
constexpr float kPerLimestone = 1.0F / kLimestoneMetres;

Plan innerPlan(const Basin& basin) {
    return {basin.centre[0], basin.centre[2], basin.half_x, basin.half_z};
}
Plan outerPlan(const Basin& basin) {
    return innerPlan(basin).grown(basin.wall);
}
float rim(const Basin& basin) {
    return basin.centre[1] + basin.height;
}
float copingFoot(const Basin& basin) {
    return rim(basin) - std::min(kCopingHeight, 0.5F * basin.height);
}

Plan squareAround(const Pillar& pillar, float half) {
    return {pillar.base[0], pillar.base[2], half, half};
}

/// The unit of a pillar's mouldings: its radius, unless the pillar is too short for them.
float module(const Pillar& pillar) {
    return std::min(pillar.radius, pillar.height / 5.0F);
}
float shaftFoot(const Pillar& pillar) {
    return pillar.base[1] + 0.95F * module(pillar);
}
float shaftHead(const Pillar& pillar) {
    return pillar.base[1] + pillar.height - 1.10F * module(pillar);
}
float plinthHalf(const Pillar& pillar) {
    return 1.45F * pillar.radius;
}

/// Attic base: torus, fillet and the sweep into the shaft. Proportions chosen by eye.
std::array<LathePoint, 7> baseProfile(const Pillar& pillar) {
    const float y = pillar.base[1];
    const float m = module(pillar);
    const float r = pillar.radius;
    return {{{1.32F * r, y + 0.42F * m, 0.70F},
             {1.40F * r, y + 0.50F * m, 0.86F},
             {1.40F * r, y + 0.60F * m, 0.95F},
             {1.30F * r, y + 0.69F * m, 0.95F},
             {1.14F * r, y + 0.73F * m, 0.80F},
             {1.12F * r, y + 0.82F * m, 0.90F},
             {1.00F * r, y + 0.95F * m, 0.85F}}};
}

/// Necking ring, then the bell that carries the abacus.
std::array<LathePoint, 7> capitalProfile(const Pillar& pillar) {
    const float y = pillar.base[1] + pillar.height;
    const float m = module(pillar);
    const float r = pillar.radius;
    return {{{1.00F * r, y - 1.10F * m, 0.92F},
             {1.13F * r, y - 1.05F * m, 0.95F},
             {1.13F * r, y - 0.96F * m, 1.00F},
             {1.02F * r, y - 0.91F * m, 0.85F},
             {1.08F * r, y - 0.75F * m, 0.90F},
             {1.25F * r, y - 0.56F * m, 0.85F},
             {1.42F * r, y - 0.42F * m, 0.65F}}};
}

void emitTrim(const Pillar& pillar, int segments) {
    const float x = pillar.base[0];
    const float z = pillar.base[2];
    const float m = module(pillar);
    const float top = pillar.base[1] + pillar.height;
    const Plan plinth = squareAround(pillar, plinthHalf(pillar));
    const Plan abacus = squareAround(pillar, 1.5F * pillar.radius);
    const Skin skin{kPerLimestone, kPerLimestone, 1.0F, 0.1F};
    emitSides(plinth, {pillar.base[1], pillar.base[1] + 0.42F * m}, {kPerLimestone, kPerLimestone, 0.65F, 0.1F});
    emitTop(plinth, pillar.base[1] + 0.42F * m, kPerLimestone);
    emitLathe(x, z, baseProfile(pillar), segments, 2.0F, kPerLimestone);
    emitLathe(x, z, capitalProfile(pillar), segments, 2.0F, kPerLimestone);
    emitUnderside(abacus, top - 0.42F * m, kPerLimestone);
    emitSides(abacus, {top - 0.42F * m, top}, skin);
    emitTop(abacus, top, kPerLimestone);
}

void emitShaft(const Pillar& pillar, int segments) {
    const float foot = shaftFoot(pillar);
    const float head = shaftHead(pillar);
    const float r = pillar.radius;
    const float quarter = 0.25F * (head - foot);
    const std::array<LathePoint, 4> profile{{{r, foot, 0.80F},
                                             {r, foot + std::min(0.4F, quarter), 1.0F},
                                             {r, head - std::min(0.3F, quarter), 1.0F},
                                             {r, head, 0.88F}}};
    emitLathe(pillar.base[0], pillar.base[2], profile, segments, kShaftTurns, 1.2F);
}

/// Runs `emit` in a crate's own frame, in which it is the unit cube.
template <typename Emit>
void inCrate(const Crate& crate, const Emit& emit) {
    glPushMatrix();
    glTranslatef(crate.centre[0], crate.centre[1], crate.centre[2]);
    glRotatef(crate.turn_degrees, 0.0F, 1.0F, 0.0F);
    glScalef(crate.size, crate.size, crate.size);
    emit();
    glPopMatrix();
}

bool onFloor(float foot, const EngineScene& scene) {
    return std::abs(foot - scene.floor_height) < 0.05F;
}

Plan enclosurePlan(const EngineScene& scene) {
    return {0.0F, 0.0F, scene.floor_half_extent, scene.floor_half_extent};
}

}  // namespace

void emitPaving(const EngineScene& scene) {
    constexpr int kCells = 8;
    emitGround(enclosurePlan(scene), scene.floor_height, kPavingMetres, kCells);
}

void emitPoolFloors(const EngineScene& scene) {
    for (const Basin& basin : scene.basins) {
        const Plan plan = innerPlan(basin);
        const float y = basin.centre[1];
        glBegin(GL_QUADS);
        glNormal3f(0.0F, 1.0F, 0.0F);
        glColor3f(1.0F, 1.0F, 1.0F);
        for (const auto& [s, t] : {std::array{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}}) {
            glTexCoord2f(s, t);
            glVertex3f(plan.x + plan.half_x * (2.0F * s - 1.0F), y, plan.z + plan.half_z * (2.0F * t - 1.0F));
        }
        glEnd();
    }
}

void emitPoolWalls(const EngineScene& scene) {
    for (const Basin& basin : scene.basins) {
        const Span span{basin.centre[1], copingFoot(basin)};
        emitInnerSides(innerPlan(basin), span, {1.0F / kPoolWallMetres, 1.0F / (span.high - span.low), 0.66F, 0.3F});
    }
}

void emitAshlar(const EngineScene& scene) {
    for (const Basin& basin : scene.basins) {
        emitSides(outerPlan(basin), {basin.centre[1], copingFoot(basin)},
                  {1.0F / kAshlarMetres, 1.0F / kAshlarMetres, 0.62F, 0.3F});
    }
}

void emitLimestone(const EngineScene& scene) {
    const Skin skin{kPerLimestone, kPerLimestone, 1.0F, 0.1F};
    for (const Basin& basin : scene.basins) {
        const Plan coping = outerPlan(basin).grown(kCopingOverhang);
        emitSides(coping, {copingFoot(basin), rim(basin)}, skin);
        emitInnerSides(innerPlan(basin), {copingFoot(basin), rim(basin)}, skin);
        emitRing(innerPlan(basin), coping, rim(basin), kPerLimestone);
        emitUnderRing(outerPlan(basin), coping, copingFoot(basin), kPerLimestone);
    }
    for (const Pillar& pillar : scene.pillars) {
        emitTrim(pillar, kPillarSegments);
    }
    if (scene.enclosure_height > 0.0F) {
        const Plan plan = enclosurePlan(scene);
        emitRing(plan, plan.grown(0.4F), scene.floor_height + scene.enclosure_height, kPerLimestone);
    }
}

void emitShafts(const EngineScene& scene) {
    for (const Pillar& pillar : scene.pillars) {
        emitShaft(pillar, kPillarSegments);
    }
}

void emitEnclosure(const EngineScene& scene) {
    if (scene.enclosure_height <= 0.0F) {
        return;
    }
    // A whole number of arches on each side.
    const float length = 2.0F * scene.floor_half_extent;
    const float arches = std::max(1.0F, std::round(length / kArcadeMetres));
    emitInnerSides(enclosurePlan(scene), {scene.floor_height, scene.floor_height + scene.enclosure_height},
                   {arches / length, 1.0F / scene.enclosure_height, 0.75F, 0.5F});
}

void emitCrates(const EngineScene& scene) {
    for (const Crate& crate : scene.crates) {
        inCrate(crate, emitCube);
    }
}

void emitContacts(const EngineScene& scene) {
    const float y = scene.floor_height;
    for (const Pillar& pillar : scene.pillars) {
        if (onFloor(pillar.base[1], scene)) {
            emitContactOutside(squareAround(pillar, plinthHalf(pillar)), y, 0.18F);
        }
    }
    for (const Basin& basin : scene.basins) {
        if (onFloor(basin.centre[1], scene)) {
            emitContactInside(innerPlan(basin), y, std::min({0.22F, basin.half_x, basin.half_z}));
            emitContactOutside(outerPlan(basin), y, 0.25F);
        }
    }
    for (const Crate& crate : scene.crates) {
        if (onFloor(crate.centre[1] - 0.5F * crate.size, scene)) {
            // The patch lies at the crate's foot, in its own units.
            const float foot = (y - crate.centre[1]) / crate.size;
            inCrate(crate, [foot] { emitContactOutside({0.0F, 0.0F, 0.5F, 0.5F}, foot, 0.28F); });
        }
    }
    if (scene.enclosure_height > 0.0F) {
        emitContactInside(enclosurePlan(scene), y, std::min(0.8F, scene.floor_half_extent));
    }
}

void emitCasters(const EngineScene& scene) {
    const Skin bare{1.0F, 1.0F, 1.0F, 1000.0F};
    for (const Pillar& pillar : scene.pillars) {
        emitTrim(pillar, kCasterSegments);
        emitShaft(pillar, kCasterSegments);
    }
    for (const Basin& basin : scene.basins) {
        const Plan coping = outerPlan(basin).grown(kCopingOverhang);
        emitSides(outerPlan(basin), {basin.centre[1], rim(basin)}, bare);
        emitInnerSides(innerPlan(basin), {basin.centre[1], rim(basin)}, bare);
        emitRing(innerPlan(basin), coping, rim(basin), 1.0F);
    }
    emitCrates(scene);
    if (scene.enclosure_height > 0.0F) {
        emitInnerSides(enclosurePlan(scene), {scene.floor_height, scene.floor_height + scene.enclosure_height}, bare);
    }
}

}  // namespace sluice::host
