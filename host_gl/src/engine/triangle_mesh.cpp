// SPDX-License-Identifier: MIT
#include "engine/triangle_mesh.hpp"

#include <epoxy/gl.h>

#include <cmath>
#include <map>
#include <vector>

namespace sluice::host {
namespace {

constexpr float kCrease = 0.766F;  // cosine of 40 degrees
constexpr float kPeriods = 1.0F;   // of the texture, a metre

/// Twice the triangle's area along its normal.
Vec3 areaOf(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
    const Vec3& a = mesh.corners[triangle[0]];
    Vec3 u{};
    Vec3 v{};
    for (std::size_t i = 0; i < 3; ++i) {
        u.at(i) = mesh.corners[triangle[1]].at(i) - a.at(i);
        v.at(i) = mesh.corners[triangle[2]].at(i) - a.at(i);
    }
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

float dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The mean of those of `areas` that face nearly as `own` does, weighted by their size.
Vec3 smooth(const std::vector<Vec3>& areas, const Vec3& own) {
    Vec3 sum{};
    for (const Vec3& area : areas) {
        if (dot(area, own) >= kCrease * std::sqrt(dot(area, area) * dot(own, own))) {
            for (std::size_t i = 0; i < 3; ++i) {
                sum.at(i) += area.at(i);
            }
        }
    }
    const float length = std::sqrt(dot(sum, sum));
    return length > 0.0F ? Vec3{sum[0] / length, sum[1] / length, sum[2] / length} : Vec3{0.0F, 1.0F, 0.0F};
}

}  // namespace

void emitTriangles(const TriangleMesh& mesh) {
    std::map<Vec3, std::vector<Vec3>> about;  // by place: files repeat corners
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t corner : triangle) {
            about[mesh.corners[corner]].push_back(areaOf(mesh, triangle));
        }
    }
    glBegin(GL_TRIANGLES);
    glColor3f(1.0F, 1.0F, 1.0F);
    for (const auto& triangle : mesh.triangles) {
        const Vec3 own = areaOf(mesh, triangle);
        const std::size_t facing = std::abs(own[1]) >= std::abs(own[0]) && std::abs(own[1]) >= std::abs(own[2]) ? 1
                                   : std::abs(own[0]) >= std::abs(own[2])                                       ? 0
                                                                                                                : 2;
        for (const std::uint32_t corner : triangle) {
            const Vec3& x = mesh.corners[corner];
            const Vec3 normal = smooth(about[x], own);
            glNormal3f(normal[0], normal[1], normal[2]);
            glTexCoord2f(kPeriods * (facing == 0 ? x[2] : x[0]), kPeriods * (facing == 1 ? x[2] : x[1]));
            glVertex3f(x[0], x[1], x[2]);
        }
    }
    glEnd();
}

}  // namespace sluice::host
