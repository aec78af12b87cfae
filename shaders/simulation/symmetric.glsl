// SPDX-License-Identifier: MIT
// Symmetric 3x3 matrices: their axes by Jacobi's rotations, a fixed number of them, so that no input loops longer.
#ifndef SLUICE_SYMMETRIC_GLSL
#define SLUICE_SYMMETRIC_GLSL

// One rotation in the plane of axes p and q: afterwards their common entry is 0. `rp`, `rq`: their entries with the third.
void rotateAxes(inout float pp, inout float qq, inout float pq, inout float rp, inout float rq, inout vec3 p_axis,
                inout vec3 q_axis) {
    // Entries are about 0.1 where they are not 0: what is below this turns nothing that a float could tell.
    const bool turns = abs(pq) > 1e-12;
    const float theta = (qq - pp) / (turns ? 2.0 * pq : 1.0);
    const float t = turns ? (theta < 0.0 ? -1.0 : 1.0) / (abs(theta) + sqrt(theta * theta + 1.0)) : 0.0;
    const float c = inversesqrt(t * t + 1.0);
    const float s = t * c;
    pp -= t * pq;
    qq += t * pq;
    pq = 0.0;
    const float r = rp;
    rp = c * r - s * rq;
    rq = s * r + c * rq;
    const vec3 axis = p_axis;
    p_axis = c * axis - s * q_axis;
    q_axis = s * axis + c * q_axis;
}

// The axes (columns, orthonormal) and the three values along them of a matrix with this diagonal and xy, xz, yz. The values
// should be within a few powers of ten of 1. Five sweeps: three leave 1e-4 of some, four 1e-7.
mat3 axesOf(vec3 diagonal, vec3 others, out vec3 values) {
    float xx = diagonal.x;
    float yy = diagonal.y;
    float zz = diagonal.z;
    float xy = others.x;
    float xz = others.y;
    float yz = others.z;
    vec3 a = vec3(1, 0, 0);
    vec3 b = vec3(0, 1, 0);
    vec3 c = vec3(0, 0, 1);
    for (int sweep = 0; sweep < 5; ++sweep) {
        rotateAxes(xx, yy, xy, xz, yz, a, b);
        rotateAxes(xx, zz, xz, xy, yz, a, c);
        rotateAxes(yy, zz, yz, xy, xz, b, c);
    }
    values = vec3(xx, yy, zz);
    return mat3(a, b, c);
}

#endif
