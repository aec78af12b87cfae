// SPDX-License-Identifier: MIT
// The vertex of a splat that is a sphere: splat.vert says what of. Particle centres, world metres, three floats each.
#ifndef SLUICE_VERTEX_SPHERE_GLSL
#define SLUICE_VERTEX_SPHERE_GLSL
#include "place_splat.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Positions { float position[]; };

layout(location = 0) flat out vec3 out_eye;

// The number of the particle.
uint placeSphere() {
    const uint particle = uint(gl_VertexIndex) / VERTICES;
    const uint corner = uint(gl_VertexIndex) - particle * VERTICES;
    const vec3 world = vec3(position[3u * particle], position[3u * particle + 1u], position[3u * particle + 2u]);
    const vec3 eye = (frame.view * vec4(world, 1.0)).xyz;
    out_eye = eye;
    placeSplat(ndcBounds(eye, splatRadius()), eye, isNear(depthOf(world)), corner);
    return particle;
}

#endif
