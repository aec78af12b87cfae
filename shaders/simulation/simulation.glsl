// SPDX-License-Identifier: MIT
// What every pass of the solver shares; mirrors renderer_vk/src/simulation/parameters.hpp. World space, +y up, metres and
// seconds; densities are in units of the rest density. docs/simulation.md has the formulas.
#ifndef SLUICE_SIMULATION_GLSL
#define SLUICE_SIMULATION_GLSL

const uint MAX_SOLIDS = 80u;  // kMaxSolids + kMaxBodies
// 1: several fluids. The last of a velocity, of `before` and of `moving` is then the number of the particle's fluid, and that of
// `sorted` the inverse of its density; else all are 0.
layout(constant_id = 5) const uint FLUIDS = 0u;

struct Fluid {
    vec4 a;  // x = density, y = 1 / density, z = XSPH, w = tension
    vec4 b;  // x = adhesion
};

struct Solid {
    vec4 a;  // plane: unit normal; others: centre or first end; w = kind
    vec4 b;  // second end, or half extents; w = radius, or the plane's offset along its normal
    vec4 q;  // box: quaternion from its axes to the world's
};

layout(std140, set = 0, binding = 0) uniform Parameters {
    vec4 gravity;    // xyz m/s^2, w = time step, s
    vec4 low;        // low corner of the domain, w = particle radius
    vec4 high;       // high corner, w = support h of the kernels
    vec4 kernel;     // x = poly6 factor, y = factor of spiky's gradient (negative), z = relaxation 1/m^2, w = tensile m^2
    vec4 fluid;      // x = XSPH, y = vorticity confinement, z = 1 / the kernel (poly6: its bracket) at the tensile distance, w = 1/dt
    vec4 search;     // x = 1 / side of a cell, which is a little wider than the support; y = factor of a wall's density
    vec4 constraint;  // kernels but poly6: x = V W(0), y = -x / h^2, z, w = factors of a wall's density and of its slope, w in 1/m
    uvec4 count;     // x = particles of the step, y = distance between two rows of the lists, z = most neighbours, w = solids
                     // and bodies
    uvec4 grid;      // x = cells along x, y and z = masks along y and z, w = cells
    uvec4 change;    // x = particles before the sort, of which some may be gone; y = births after the step, z = the
                     // identity of the first of them, w = solids that are no bodies
    vec4 surface;    // x = cohesion, y = curvature, z = adhesion, m/s^2; w = 1: adhesion is on
    vec4 adhesion[5];  // of a half-space, at distances of 0, 1/16, ... 1 support; the last three are 0
    Solid solid[MAX_SOLIDS];
    Fluid kind[8];   // where FLUIDS
} p;

// Faults, reported by the host: simulation/status.hpp.
const uint FAULT_NOT_FINITE = 1u;
const uint FAULT_CROWDED = 2u;
// Instead of its cell, of a particle that a drain took or that was never born.
const uint GONE = 0xffffffffu;
// llvmpipe stops an invocation silently after 65,535 loop iterations; so many candidates are refused before.
const uint MOST_CANDIDATES = 60000u;

// By the bits: a compiler may assume that arithmetic has no NaN.
bool isBad(float x) { return (floatBitsToUint(x) & 0x7f800000u) == 0x7f800000u; }
bool isBad(vec3 v) { return isBad(v.x) || isBad(v.y) || isBad(v.z); }

// The cell that a position lies in. x has a column of empty cells on both sides; y and z wrap around, so that the table
// stays small whatever the domain: a bucket may then hold particles from far away, which the distance tells apart.
ivec3 cellOf(vec3 x) {
    const vec3 cell = floor((x - p.low.xyz) * p.search.x);
    // min and max, in this order, so that a NaN (already reported) still gives a cell.
    return ivec3(clamp(int(min(max(cell.x, 0.0), 1e6)), 0, int(p.grid.x) - 3) + 1,
                 int(min(max(cell.y, 0.0), 1e6)), int(min(max(cell.z, 0.0), 1e6)));
}
uint rowOf(int y, int z) { return ((uint(z) & p.grid.z) * (p.grid.y + 1u) + (uint(y) & p.grid.y)) * p.grid.x; }

// From j to i, and its length. Two particles in one place have no direction: they get one out of their numbers, opposite
// for the other of the pair, so that momentum is kept.
vec4 between(vec3 a, vec3 b, uint i, uint j) {
    vec3 d = a - b;
    float square = dot(d, d);
    const float tiny = 1e-5 * p.high.w;
    if (square < tiny * tiny) {
        const uint bits = i ^ j;
        const vec3 away = vec3((bits & 1u) == 0u ? 0.36 : -0.36, (bits & 2u) == 0u ? 0.48 : -0.48,
                               (bits & 4u) == 0u ? 0.8 : -0.8);
        d = (i < j ? -tiny : tiny) * away;
        square = tiny * tiny;
    }
    return vec4(d, sqrt(square));
}

#endif
