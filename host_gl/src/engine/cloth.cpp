// SPDX-License-Identifier: MIT
#include "engine/cloth.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>

namespace sluice::host {
namespace {

constexpr float kGravity = 9.81F;
/// Of a point's speed, what air leaves of it in a second; more makes the banner slow, less lets it ring.
constexpr float kKeptPerSecond = 0.35F;
/// m/s^2 of the wind at its strongest, about half of gravity: the banner leans and does not fly.
constexpr float kWind = 5.0F;
/// An engine whose frame took longer lets its banners lag behind.
constexpr float kLongestStep = 1.0F / 30.0F;
constexpr Vec3 kDye{0.62F, 0.10F, 0.09F};  ///< sRGB-encoded

Vec3 minus(const Vec3& a, const Vec3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
float lengthOf(const Vec3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}
Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

Cloth::Cloth(const Banner& banner) : cells_(banner.cells), iterations_(banner.iterations) {
    const auto cells = static_cast<float>(cells_);
    const Vec3 along = minus(banner.to, banner.from);
    across_ = lengthOf(along) / cells;
    down_ = banner.drop / cells;
    slant_ = std::hypot(across_, down_);
    const Vec3 through = cross(along, {0.0F, 1.0F, 0.0F});
    const float length = std::max(lengthOf(through), 1e-6F);
    wind_ = {through[0] / length, through[1] / length, through[2] / length};
    for (std::uint32_t row = 0; row <= cells_; ++row) {
        for (std::uint32_t column = 0; column <= cells_; ++column) {
            const float u = static_cast<float>(column) / cells;
            now_.push_back({banner.from[0] + u * along[0],
                            banner.from[1] + u * along[1] - down_ * static_cast<float>(row),
                            banner.from[2] + u * along[2]});
        }
    }
    before_ = now_;
}

void Cloth::relax(std::uint32_t a, std::uint32_t b, float length) {
    Vec3& p = now_[a];
    Vec3& q = now_[b];
    const Vec3 apart = minus(q, p);
    const float found = std::max(lengthOf(apart), 1e-9F);
    // The pinned row is heavy beyond measure.
    const bool pinned = a <= cells_;
    if (pinned && b <= cells_) {
        return;
    }
    const float give = (found - length) / found * (pinned ? 1.0F : 0.5F);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] += pinned ? 0.0F : give * apart[axis];
        q[axis] -= give * apart[axis];
    }
}

void Cloth::relaxAll() {
    for (std::uint32_t row = 0; row <= cells_; ++row) {
        for (std::uint32_t column = 0; column <= cells_; ++column) {
            const std::uint32_t here = index(row, column);
            if (column < cells_) {
                relax(here, here + 1, across_);
            }
            if (row < cells_) {
                relax(here, index(row + 1, column), down_);
            }
            if (row < cells_ && column < cells_) {
                relax(here, index(row + 1, column + 1), slant_);
                relax(here + 1, index(row + 1, column), slant_);
            }
        }
    }
}

void Cloth::step(float seconds) {
    const float dt = std::clamp(seconds, 0.0F, kLongestStep);
    time_ += dt;
    const float kept = std::pow(kKeptPerSecond, dt);
    for (std::uint32_t row = 1; row <= cells_; ++row) {
        for (std::uint32_t column = 0; column <= cells_; ++column) {
            const std::uint32_t here = index(row, column);
            const Vec3 at = now_[here];
            // Gusts that run along and down the banner.
            const float gust = 0.5F + 0.5F * std::sin(2.1F * time_ + 3.0F * at[0] + 2.0F * at[1] + 2.5F * at[2]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float pull = kWind * gust * wind_[axis] - (axis == 1 ? kGravity : 0.0F);
                now_[here][axis] = at[axis] + kept * (at[axis] - before_[here][axis]) + pull * dt * dt;
            }
            before_[here] = at;
        }
    }
    for (std::uint32_t i = 0; i < iterations_; ++i) {
        relaxAll();
    }
}

float Cloth::stretch() const {
    float most = 0.0F;
    for (std::uint32_t row = 0; row < cells_; ++row) {
        for (std::uint32_t column = 0; column <= cells_; ++column) {
            most = std::max(most, lengthOf(minus(now_[index(row + 1, column)], now_[index(row, column)])) / down_);
        }
    }
    return most;
}

Vec3 Cloth::normal(std::uint32_t row, std::uint32_t column) const {
    const Vec3 along = minus(now_[index(row, std::min(column + 1, cells_))], now_[index(row, column - (column > 0))]);
    const Vec3 down = minus(now_[index(std::min(row + 1, cells_), column)], now_[index(row - (row > 0), column)]);
    return cross(down, along);  // GL_NORMALIZE is on
}

void Cloth::emit() const {
    glPushAttrib(GL_ENABLE_BIT | GL_CURRENT_BIT | GL_POLYGON_BIT);
    glDisable(GL_TEXTURE_2D);
    glEnable(GL_CULL_FACE);
    glColor3f(kDye[0], kDye[1], kDye[2]);
    for (const bool back : {false, true}) {
        glCullFace(back ? GL_FRONT : GL_BACK);
        for (std::uint32_t row = 0; row < cells_; ++row) {
            glBegin(GL_TRIANGLE_STRIP);
            for (std::uint32_t column = 0; column <= cells_; ++column) {
                for (const std::uint32_t at : {row, row + 1}) {
                    const Vec3 n = normal(at, column);
                    const float side = back ? -1.0F : 1.0F;
                    glNormal3f(side * n[0], side * n[1], side * n[2]);
                    glVertex3fv(now_[index(at, column)].data());
                }
            }
            glEnd();
        }
    }
    glPopAttrib();
}

}  // namespace sluice::host
