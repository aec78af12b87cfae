// SPDX-License-Identifier: MIT
#include "engine/mesh.hpp"

#include <epoxy/gl.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace sluice::host {
namespace {

struct Ground {
    float x, z;
};

void grey(float value) {
    glColor3f(value, value, value);
}

void panelRow(const Ground& a, const Ground& b, const Span& span, const Span& greys, const Skin& skin, float u_end,
              float base) {
    const float v_low = (span.low - base) * skin.v_per_metre;
    const float v_high = (span.high - base) * skin.v_per_metre;
    grey(greys.low);
    glTexCoord2f(0.0F, v_low);
    glVertex3f(a.x, span.low, a.z);
    glTexCoord2f(u_end, v_low);
    glVertex3f(b.x, span.low, b.z);
    grey(greys.high);
    glTexCoord2f(u_end, v_high);
    glVertex3f(b.x, span.high, b.z);
    glTexCoord2f(0.0F, v_high);
    glVertex3f(a.x, span.high, a.z);
}

/// One upright wall from a to b; its normal is (b - a) x up.
void panel(const Ground& a, const Ground& b, const Span& span, const Skin& skin) {
    const float length = std::hypot(b.x - a.x, b.z - a.z);
    glNormal3f(-(b.z - a.z) / length, 0.0F, (b.x - a.x) / length);
    const float u_end = length * skin.u_per_metre;
    const float bend = std::fmin(span.low + skin.foot_height, span.high);
    panelRow(a, b, {span.low, bend}, {skin.foot, 1.0F}, skin, u_end, span.low);
    if (bend < span.high) {
        panelRow(a, b, {bend, span.high}, {1.0F, 1.0F}, skin, u_end, span.low);
    }
}

std::array<Ground, 4> corners(const Plan& p) {
    return {{{p.x - p.half_x, p.z + p.half_z},
             {p.x + p.half_x, p.z + p.half_z},
             {p.x + p.half_x, p.z - p.half_z},
             {p.x - p.half_x, p.z - p.half_z}}};
}

void flatVertex(const Ground& p, float y, float per_metre) {
    glTexCoord2f(p.x * per_metre, p.z * per_metre);
    glVertex3f(p.x, y, p.z);
}

void contactVertex(const Ground& p, float y, float s, float t) {
    glTexCoord2f(s, t);
    glVertex3f(p.x, y, p.z);
}

}  // namespace

void emitSides(const Plan& plan, const Span& span, const Skin& skin) {
    const auto corner = corners(plan);
    glBegin(GL_QUADS);
    for (std::size_t i = 0; i < 4; ++i) {
        panel(corner[i], corner[(i + 1) % 4], span, skin);
    }
    glEnd();
}

void emitInnerSides(const Plan& plan, const Span& span, const Skin& skin) {
    const auto corner = corners(plan);
    glBegin(GL_QUADS);
    for (std::size_t i = 0; i < 4; ++i) {
        panel(corner[(i + 1) % 4], corner[i], span, skin);
    }
    glEnd();
}

void emitTop(const Plan& plan, float y, float per_metre) {
    glBegin(GL_QUADS);
    glNormal3f(0.0F, 1.0F, 0.0F);
    grey(1.0F);
    for (const Ground& corner : corners(plan)) {
        flatVertex(corner, y, per_metre);
    }
    glEnd();
}

void emitUnderside(const Plan& plan, float y, float per_metre) {
    const auto corner = corners(plan);
    glBegin(GL_QUADS);
    glNormal3f(0.0F, -1.0F, 0.0F);
    grey(0.6F);
    for (std::size_t i = 4; i-- > 0;) {
        flatVertex(corner[i], y, per_metre);
    }
    glEnd();
}

void emitRing(const Plan& inner, const Plan& outer, float y, float per_metre) {
    const auto in = corners(inner);
    const auto out = corners(outer);
    glBegin(GL_QUADS);
    glNormal3f(0.0F, 1.0F, 0.0F);
    grey(1.0F);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        for (const Ground& corner : {out[i], out[next], in[next], in[i]}) {
            flatVertex(corner, y, per_metre);
        }
    }
    glEnd();
}

void emitUnderRing(const Plan& inner, const Plan& outer, float y, float per_metre) {
    const auto in = corners(inner);
    const auto out = corners(outer);
    glBegin(GL_QUADS);
    glNormal3f(0.0F, -1.0F, 0.0F);
    grey(0.6F);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        for (const Ground& corner : {in[i], in[next], out[next], out[i]}) {
            flatVertex(corner, y, per_metre);
        }
    }
    glEnd();
}

void emitGround(const Plan& plan, float y, float metres, int cells) {
    const float per_metre = 1.0F / metres;
    const auto at = [cells](float centre, float half, int i) {
        return centre - half + 2.0F * half * static_cast<float>(i) / static_cast<float>(cells);
    };
    glNormal3f(0.0F, 1.0F, 0.0F);
    grey(1.0F);
    for (int row = 0; row < cells; ++row) {
        glBegin(GL_QUAD_STRIP);
        for (int column = 0; column <= cells; ++column) {
            const float x = at(plan.x, plan.half_x, column);
            flatVertex({x, at(plan.z, plan.half_z, row)}, y, per_metre);
            flatVertex({x, at(plan.z, plan.half_z, row + 1)}, y, per_metre);
        }
        glEnd();
    }
}

void emitLathe(float x, float z, std::span<const LathePoint> profile, int segments, float u_turns, float v_per_metre) {
    struct Slope {
        float out, up;
    };
    std::vector<Slope> normals(profile.size(), Slope{0.0F, 0.0F});
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const float rise = profile[i + 1].y - profile[i].y;
        const float spread = profile[i + 1].radius - profile[i].radius;
        const float length = std::hypot(rise, spread);
        for (const std::size_t end : {i, i + 1}) {
            normals[end].out += rise / length;
            normals[end].up -= spread / length;
        }
    }
    const auto vertex = [&](std::size_t i, float turn) {
        const float sine = std::sin(turn * 2.0F * std::numbers::pi_v<float>);
        const float cosine = std::cos(turn * 2.0F * std::numbers::pi_v<float>);
        const float length = std::hypot(normals[i].out, normals[i].up);
        grey(profile[i].grey);
        glNormal3f(sine * normals[i].out / length, normals[i].up / length, cosine * normals[i].out / length);
        glTexCoord2f(turn * u_turns, profile[i].y * v_per_metre);
        glVertex3f(x + sine * profile[i].radius, profile[i].y, z + cosine * profile[i].radius);
    };
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        glBegin(GL_QUAD_STRIP);
        for (int segment = 0; segment <= segments; ++segment) {
            const float turn = static_cast<float>(segment) / static_cast<float>(segments);
            vertex(i + 1, turn);
            vertex(i, turn);
        }
        glEnd();
    }
}

void emitCube() {
    const Plan base{0.0F, 0.0F, 0.5F, 0.5F};
    emitSides(base, {-0.5F, 0.5F}, {1.0F, 1.0F, 0.62F, 0.35F});
    const auto corner = corners(base);
    for (const float side : {1.0F, -1.0F}) {
        glBegin(GL_QUADS);
        glNormal3f(0.0F, side, 0.0F);
        grey(side > 0.0F ? 1.0F : 0.6F);
        for (std::size_t i = 0; i < 4; ++i) {
            const Ground& p = corner[side > 0.0F ? i : 3 - i];
            glTexCoord2f(p.x + 0.5F, p.z + 0.5F);
            glVertex3f(p.x, side * 0.5F, p.z);
        }
        glEnd();
    }
}

void emitContactOutside(const Plan& plan, float y, float width) {
    const auto in = corners(plan);
    const auto out = corners(plan.grown(width));
    glBegin(GL_QUADS);
    for (const Ground& corner : in) {
        contactVertex(corner, y, 0.0F, 0.0F);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const Ground& a = in[i];
        const Ground& b = in[(i + 1) % 4];
        const Ground& far_a = out[i];
        const Ground& far_b = out[(i + 1) % 4];
        const bool along_x = a.z == b.z;
        const Ground edge_a = along_x ? Ground{a.x, far_a.z} : Ground{far_a.x, a.z};
        const Ground edge_b = along_x ? Ground{b.x, far_b.z} : Ground{far_b.x, b.z};
        contactVertex(edge_a, y, 1.0F, 0.0F);
        contactVertex(edge_b, y, 1.0F, 0.0F);
        contactVertex(b, y, 0.0F, 0.0F);
        contactVertex(a, y, 0.0F, 0.0F);
        // The corner after b: a quarter of the blob.
        const Ground turn = along_x ? Ground{far_b.x, b.z} : Ground{b.x, far_b.z};
        contactVertex(b, y, 0.0F, 0.0F);
        contactVertex(edge_b, y, 1.0F, 0.0F);
        contactVertex(far_b, y, 1.0F, 1.0F);
        contactVertex(turn, y, 0.0F, 1.0F);
    }
    glEnd();
}

void emitContactInside(const Plan& plan, float y, float width) {
    const auto in = corners(plan.grown(-width));
    const auto out = corners(plan);
    glBegin(GL_QUADS);
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        contactVertex(out[i], y, 0.0F, 0.0F);
        contactVertex(out[next], y, 0.0F, 0.0F);
        contactVertex(in[next], y, 1.0F, 0.0F);
        contactVertex(in[i], y, 1.0F, 0.0F);
    }
    glEnd();
}

}  // namespace sluice::host
