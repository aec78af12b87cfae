// SPDX-License-Identifier: MIT
// The vertex of a splat that is an ellipsoid: splat_ellipsoid.vert says what of.
#ifndef SLUICE_VERTEX_ELLIPSOID_GLSL
#define SLUICE_VERTEX_ELLIPSOID_GLSL
#include "ellipsoid.glsl"
#include "place_splat.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Ellipsoids { float ellipsoid[]; };

layout(location = 0) flat out vec3 out_eye;
layout(location = 1) flat out vec3 out_first;   // xx, xy, xz
layout(location = 2) flat out vec3 out_second;  // yy, yz, zz

vec3 triple(uint at) { return vec3(ellipsoid[at], ellipsoid[at + 1u], ellipsoid[at + 2u]); }

// The number of the particle.
uint placeEllipsoid() {
    const uint particle = uint(gl_VertexIndex) / VERTICES;
    const uint corner = uint(gl_VertexIndex) - particle * VERTICES;
    const uint at = 9u * particle;
    const vec3 world = triple(at);
    const vec3 eye = (frame.view * vec4(world, 1.0)).xyz;
    out_eye = eye;
    const mat3 turn = mat3(frame.view);
    const mat3 stretch = turn * symmetric(triple(at + 3u), triple(at + 6u)) * transpose(turn);
    // The inverse by cofactors: the rows of a symmetric matrix are its columns.
    const vec3 a = cross(stretch[1], stretch[2]);
    const float scale = 1.0 / (dot(stretch[0], a) * splatRadius());
    const vec3 b = cross(stretch[2], stretch[0]);
    const vec3 c = cross(stretch[0], stretch[1]);
    out_first = a * scale;
    out_second = vec3(b.y, b.z, c.z) * scale;
    const mat3 square = stretch * transpose(stretch) * (splatRadius() * splatRadius());
    placeSplat(ndcBoundsOfEllipsoid(eye, square), eye, isNear(depthOf(world)), corner);
    return particle;
}

#endif
