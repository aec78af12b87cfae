// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
// The ellipsoid that stands for each particle, from where its neighbours lie (after Yu & Turk 2013): flat where they form a
// surface, long where they form a thread, small and round where there are none. docs/simulation.md has the formulas.
// Inputs:  the particles of the last step in sorted order with their lists; behind them those that were born at its end.
//          Whose they are, and places.comp's count where somebody comes or goes and places are asked for.
// Outputs: nine floats for each place: centre, world metres; then xx, xy, xz, yy, yz, zz of the symmetric stretch M that
//          makes a sphere of radius R about the centre into the ellipsoid { centre + R M u, |u| <= 1 }.
// Bound of its test: 2e-5 in every entry of M, 1e-5 radii in the centre.
#include "places.glsl"
#include "simulation.glsl"
#include "symmetric.glsl"

layout(local_size_x = 64) in;
layout(push_constant) uniform Push {
    uint entries;     // particles, of which some may be gone
    uint moved;       // of those, the ones that have lists
    float ratio;      // greatest of the longest to the shortest axis
    float smoothing;  // how far the centre goes to the mean of its neighbours, 0 to 1
    float lonely;     // size of a particle without neighbours
    uint placed;      // 0: the place is the identity, and marks and before are nothing
} push;
layout(set = 0, binding = 1) uniform textureBuffer sorted;
layout(set = 0, binding = 2) uniform utextureBuffer list;
layout(std430, set = 0, binding = 3) readonly buffer ListCount { uint list_count[]; };
layout(std430, set = 0, binding = 4) readonly buffer Positions { vec4 position[]; };
layout(std430, set = 0, binding = 5) readonly buffer Identities { uint identity[]; };
layout(std430, set = 0, binding = 6) writeonly buffer Ellipsoids { float ellipsoid[]; };
layout(std430, set = 0, binding = 7) readonly buffer Marks { uint marks[]; };
layout(std430, set = 0, binding = 8) readonly buffer Before { uint before[]; };

// Variance along an axis of the weighted neighbours of a lattice at rest, in squares of the support.
const float AT_REST = 0.144627;
// Weight of the belief that neighbours are as at rest, in particles: it makes the shape of few neighbours rounder, and
// lets a neighbour that comes or goes change nothing by leaps.
const float BELIEF = 0.5;
// Sum of the weights of neighbours from which a particle has its full size: a sheet of one layer has 6.1, a thread 1.8.
const float ENOUGH = 3.0;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= push.entries || position[i].w != 0.0) {
        return;
    }
    const vec3 x = position[i].xyz;
    const float h = p.high.w;
    const uint number = i < push.moved ? list_count[i] : 0u;
    float weights = 0.0;
    vec3 mean = vec3(0);
    vec3 diagonal = vec3(0);
    vec3 others = vec3(0);
    uint at = i;
    for (uint k = 0u; k < number; ++k, at += p.count.y) {
        const vec3 d = (texelFetch(sorted, int(texelFetch(list, int(at)).x)).xyz - x) / h;
        const float square = dot(d, d);
        const float weight = max(1.0 - square * sqrt(square), 0.0);
        weights += weight;
        mean += weight * d;
        diagonal += weight * d * d;
        others += weight * d.xxy * d.yzz;
    }
    // The particle itself has weight 1 and distance 0.
    const float all = weights + 1.0;
    mean /= all;
    diagonal = (diagonal - all * mean * mean + BELIEF * AT_REST) / (all + BELIEF);
    others = (others - all * mean.xxy * mean.yzz) / (all + BELIEF);
    vec3 values;
    const mat3 axes = axesOf(diagonal, others, values);
    const float longest = max(values.x, max(values.y, values.z));
    const vec3 lengths = sqrt(max(values, vec3(longest / (push.ratio * push.ratio))));
    const float size = mix(push.lonely, 1.0, smoothstep(0.0, ENOUGH, weights));
    const vec3 stretch = lengths * (size / pow(lengths.x * lengths.y * lengths.z, 1.0 / 3.0));
    const vec3 a = axes[0] * stretch.x;
    const vec3 b = axes[1] * stretch.y;
    const vec3 c = axes[2] * stretch.z;
    const vec3 xs = a.x * axes[0] + b.x * axes[1] + c.x * axes[2];
    const vec3 ys = a.y * axes[0] + b.y * axes[1] + c.y * axes[2];
    const float zz = a.z * axes[0].z + b.z * axes[1].z + c.z * axes[2].z;
    const vec3 centre = x + push.smoothing * h * mean;
    uint place = identity[i];
    if (push.placed != 0u) {
        place = placeOf(marks[place >> 5], before[place >> 5], place);
    }
    const uint to = 9u * place;
    ellipsoid[to] = centre.x;
    ellipsoid[to + 1u] = centre.y;
    ellipsoid[to + 2u] = centre.z;
    ellipsoid[to + 3u] = xs.x;
    ellipsoid[to + 4u] = xs.y;
    ellipsoid[to + 5u] = xs.z;
    ellipsoid[to + 6u] = ys.y;
    ellipsoid[to + 7u] = ys.z;
    ellipsoid[to + 8u] = zz;
}
