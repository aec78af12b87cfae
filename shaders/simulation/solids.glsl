// SPDX-License-Identifier: MIT
// Solids as analytic signed distances. Exact for spheres, capsules, planes and the faces of boxes. Meshes as a grid of
// distances, for passes that have defined MESH_BINDING; what a camera sees, for those with SEEN_BINDING.
#ifndef SLUICE_SOLIDS_GLSL
#define SLUICE_SOLIDS_GLSL
#include "density.glsl"
#ifdef BODIES_BINDING
#include "bodies.glsl"
#endif
#ifdef SEEN_BINDING
#include "seen.glsl"
#endif

vec3 rotated(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

vec3 unitOr(vec3 v, vec3 otherwise) {
    const float length_ = length(v);
    return length_ > 1e-20 ? v / length_ : otherwise;
}

// xyz = unit normal out of the solid, w = distance to its surface, negative inside.
vec4 distanceTo(uint k, vec3 x) {
    const Solid s = p.solid[k];
    const uint kind = uint(s.a.w);
    if (kind == 0u) {  // plane
        return vec4(s.a.xyz, dot(s.a.xyz, x) - s.b.w);
    }
    if (kind == 3u) {  // box
        const vec3 local = rotated(vec4(-s.q.xyz, s.q.w), x - s.a.xyz);
        const vec3 side = vec3(local.x < 0.0 ? -1.0 : 1.0, local.y < 0.0 ? -1.0 : 1.0, local.z < 0.0 ? -1.0 : 1.0);
        const vec3 out_ = abs(local) - s.b.xyz;
        const float inner = max(out_.x, max(out_.y, out_.z));
        // The nearest face; of equal ones the first.
        const vec3 face = out_.x >= inner ? vec3(1, 0, 0) : (out_.y >= inner ? vec3(0, 1, 0) : vec3(0, 0, 1));
        const vec3 normal = inner > 0.0 ? unitOr(max(out_, vec3(0)), face) : face;
        return vec4(rotated(s.q, normal * side), inner > 0.0 ? length(max(out_, vec3(0))) : inner);
    }
    // Sphere, or capsule: a sphere about the nearest point of its axis.
    const vec3 axis = kind == 2u ? s.b.xyz - s.a.xyz : vec3(0);
    const float square = dot(axis, axis);
    const float along = square > 0.0 ? clamp(dot(x - s.a.xyz, axis) / square, 0.0, 1.0) : 0.0;
    const vec3 away = x - (s.a.xyz + along * axis);
    return vec4(unitOr(away, vec3(0, 1, 0)), length(away) - s.b.w);
}

#ifdef MESH_BINDING
layout(constant_id = 3) const uint MESH = 0u;
// DistanceGrid of renderer_vk/src/simulation/distance_grid.hpp.
layout(std430, set = 0, binding = MESH_BINDING) readonly buffer Mesh {
    vec4 mesh_low;    // where the first node is; w = 1 / spacing
    uvec4 mesh_size;  // xyz = nodes along each axis
    float mesh_node[];
};

// As distanceTo, between the nodes of the grid: all meshes of the scene. Far away outside it.
vec4 distanceToMesh(vec3 x) {
    const vec3 at = (x - mesh_low.xyz) * mesh_low.w;
    if (any(lessThan(at, vec3(0))) || any(greaterThan(at, vec3(mesh_size.xyz - 1u)))) {
        return vec4(0, 1, 0, 1e9);
    }
    const uvec3 cell = min(uvec3(at), mesh_size.xyz - 2u);
    const vec3 part = at - vec3(cell);
    const uint first = (cell.z * mesh_size.y + cell.y) * mesh_size.x + cell.x;
    const uint up = mesh_size.x;
    const uint away = mesh_size.x * mesh_size.y;
    const vec4 low = vec4(mesh_node[first], mesh_node[first + up], mesh_node[first + away], mesh_node[first + up + away]);
    const vec4 high = vec4(mesh_node[first + 1u], mesh_node[first + up + 1u], mesh_node[first + away + 1u],
                           mesh_node[first + up + away + 1u]);
    const vec4 along = mix(low, high, part.x);
    const vec4 slope = high - low;
    const vec2 across = mix(along.xz, along.yw, part.y);
    const vec3 normal = vec3(mix(mix(slope.x, slope.y, part.y), mix(slope.z, slope.w, part.y), part.z),
                             mix(along.y - along.x, along.w - along.z, part.z), across.y - across.x);
    return vec4(unitOr(normal, vec3(0, 1, 0)), mix(across.x, across.y, part.z));
}
#endif

// The nearest place where a particle's centre may be: a radius away from every solid, and within the domain whatever
// the solids say. `start`: where it was at the start of the step.
vec3 collided(vec3 x, vec3 start) {
    for (uint k = 0u; k < p.count.w; ++k) {
        const vec4 d = distanceTo(k, x);
        const vec3 push = d.xyz * max(p.low.w - d.w, 0.0);
#ifdef BODIES_BINDING
        if (BODIES == 1u && k >= p.change.w && d.w < p.low.w) {
            addPush(k - p.change.w, x, push);
        }
#endif
        x += push;
    }
#ifdef MESH_BINDING
    if (MESH == 1u) {  // the grid ends with the domain
        const vec4 d = distanceToMesh(clamp(x, p.low.xyz + p.low.w, p.high.xyz - p.low.w));
        x += d.xyz * max(p.low.w - d.w, 0.0);
    }
#endif
#ifdef SEEN_BINDING
    if (SEEN == 1u) {
        x = collidedWithSeen(x, start);
    }
#endif
    return clamp(x, p.low.xyz + p.low.w, p.high.xyz - p.low.w);
}

// Adds the wall at distance `d` with unit normal `n` to the walls so far: xyz gradient, w density. Where two walls
// overlap they are counted once, as if each took its share of what the other left (exact in a right-angled edge at d = 0).
vec4 withWall(vec4 walls, vec3 n, float d) {
    const float q = clamp(d / p.high.w, 0.0, 1.0);
    const float share = wallShare(q);
    return vec4(walls.xyz * (1.0 - share) - n * (halfSpaceSlope(q) * (1.0 - walls.w)),
                walls.w + share * (1.0 - walls.w));
}
vec4 wallsAt(vec3 x) {
    vec4 walls = vec4(0);
    const vec3 low = x - p.low.xyz;
    const vec3 high = p.high.xyz - x;
    walls = withWall(walls, vec3(1, 0, 0), low.x);
    walls = withWall(walls, vec3(-1, 0, 0), high.x);
    walls = withWall(walls, vec3(0, 1, 0), low.y);
    walls = withWall(walls, vec3(0, -1, 0), high.y);
    walls = withWall(walls, vec3(0, 0, 1), low.z);
    walls = withWall(walls, vec3(0, 0, -1), high.z);
    for (uint k = 0u; k < p.count.w; ++k) {
        const vec4 d = distanceTo(k, x);
        walls = withWall(walls, d.xyz, d.w);
    }
#ifdef MESH_BINDING
    if (MESH == 1u) {
        const vec4 d = distanceToMesh(x);
        walls = withWall(walls, d.xyz, d.w);
    }
#endif
    return walls;
}
#ifdef BODIES_BINDING
// The part of the walls' gradient at x that is body k's, times `factor`, is what the body shifts a particle by. `density` is
// that of all walls: each wall has what the others leave.
void addPressure(vec3 x, float density, float factor) {
    for (uint k = p.change.w; k < p.count.w; ++k) {
        const vec4 d = distanceTo(k, x);
        if (d.w < p.high.w) {
            const float q = clamp(d.w / p.high.w, 0.0, 1.0);
            const float left = (1.0 - density) / (1.0 - wallShare(q));
            addPush(k - p.change.w, x, d.xyz * (-halfSpaceSlope(q) * left * factor));
        }
    }
}
#endif

#endif
