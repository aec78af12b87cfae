// SPDX-License-Identifier: MIT
// The kernel of the density constraint, and what a wall adds to it if fluid at rest fills the wall. q: distance / support, 0
// and up. Passes that have nothing to do with the constraint leave KERNEL at poly6, with spiky's gradient.
// DensityKernel of renderer_vk/src/simulation/density_kernel.hpp has the same in doubles.
#ifndef SLUICE_DENSITY_GLSL
#define SLUICE_DENSITY_GLSL
#include "simulation.glsl"

layout(constant_id = 6) const uint KERNEL = 0u;
const uint POLY6 = 0u;
const uint SPLINE = 1u;  // cubic (Monaghan 1992); else C2 of Wendland 1995

// Of a kernel that is not poly6: its value over that at the centre.
float densityShape(float q) {
    const float a = max(1.0 - q, 0.0);
    if (KERNEL == SPLINE) {
        const float b = max(0.5 - q, 0.0);
        return 2.0 * a * a * a - 8.0 * b * b * b;
    }
    const float square = a * a;
    return square * square * (4.0 * q + 1.0);
}
// Minus its derivative, over q: what a distance vector is multiplied with.
float densityPull(float q) {
    const float a = max(1.0 - q, 0.0);
    if (KERNEL == SPLINE) {
        return q < 0.5 ? 12.0 - 18.0 * q : 6.0 * a * a / q;
    }
    return 20.0 * a * a * a;
}

// The kernel integrated over a half-space whose plane is `q` supports away, q <= 1.
float halfSpace(float q) {
    if (KERNEL == POLY6) {
        const float s = q * q;
        return 0.5 - (315.0 / 256.0) * q * (1.0 + s * (-4.0 / 3.0 + s * (6.0 / 5.0 + s * (-4.0 / 7.0 + s / 9.0))));
    }
    const float a = 1.0 - q;
    const float square = a * a;
    if (KERNEL == SPLINE) {
        const float b = max(0.5 - q, 0.0);
        const float other = b * b;
        return square * square * a * (1.6 - 16.0 / 15.0 * a) - other * other * b * (3.2 - 64.0 / 15.0 * b);
    }
    return square * square * square * (3.5 + a * (-4.5 + 1.5 * a));
}
// Minus its derivative along the normal, 1/m; of spiky for poly6.
float halfSpaceSlope(float q) {
    const float a = 1.0 - q;
    const float s = a * a;
    if (KERNEL == POLY6) {
        return 30.0 / p.high.w * s * s * (0.25 - 0.2 * a);
    }
    if (KERNEL == SPLINE) {
        const float b = max(0.5 - q, 0.0);
        const float other = b * b;
        return p.constraint.w * (s * s * (8.0 - 6.4 * a) - other * other * (16.0 - 25.6 * b));
    }
    return p.constraint.w * s * s * a * (21.0 + a * (-31.5 + 12.0 * a));
}
// What a wall `q` supports away adds to the density.
float wallShare(float q) { return (KERNEL == POLY6 ? p.search.y : p.constraint.z) * halfSpace(q); }

#endif
