// SPDX-License-Identifier: MIT
// What a camera sees as a solid: an image of depths, each texel of which stands for a piece of a surface with one side. Passes define
// SEEN_BINDING first. World space and eye space (right-handed, looks down -z), metres. docs/simulation.md has the rule and
// its reasons; DepthField of renderer_vk/src/simulation/depth_field.hpp is the image.
#ifndef SLUICE_SEEN_GLSL
#define SLUICE_SEEN_GLSL
#include "simulation.glsl"

layout(constant_id = 4) const uint SEEN = 0u;
layout(std430, set = 0, binding = SEEN_BINDING) readonly buffer Seen {
    vec4 seen_row[3];  // world to eye, rigid
    vec4 seen_lens;    // ndc = xy * slope - zw, slope = eye.xy / depth
    vec4 seen_limits;  // x = near plane, y = thickness of what is seen, zw = size of the view in texels
    uvec4 seen_size;   // xy = texels, the last of which may reach out of the view; none: nothing is seen
    float seen_depth[];  // along -z, bottom row first
};

// The plane of a texel.
struct SeenPlane {
    vec3 normal;     // unit, world, towards the eye
    float distance;  // of x to the plane, negative behind it
    float stretch;   // what distances are multiplied with where the plane is seen at a grazing angle; 0: nothing is seen
    float level;     // distance of who is a radius away along the view
    float reach;     // who is deeper behind it is hidden, and not in it: a radius, or what a texel is wide
};

// 0 where nothing is seen: nothing that a camera draws is nearer than its near plane.
float seenAt(ivec2 texel) {
    const ivec2 size = ivec2(seen_size.xy);
    if (texel.x < 0 || texel.y < 0 || texel.x >= size.x || texel.y >= size.y) {
        return 0.0;
    }
    const float depth = seen_depth[texel.y * size.x + texel.x];
    return isBad(depth) || depth > 1e29 || depth < 0.5 * seen_limits.x ? 0.0 : depth;
}

vec3 seenRay(ivec2 texel) {
    const vec2 ndc = (vec2(texel) + 0.5) * (2.0 / seen_limits.zw) - 1.0;
    return vec3((ndc + seen_lens.zw) / seen_lens.xy, -1.0);
}

// Along +axis of the side on which the surface goes on as a plane: there 1 / depth is linear in the image. Of two that do
// not, the one whose depth is nearer. Zero where that breaks off: depth there changes by more than 32 times what it does on
// a plane seen at 45 degrees.
vec3 seenTangent(ivec2 texel, ivec2 axis, float depth) {
    const float ahead = seenAt(texel + axis);
    const float behind = seenAt(texel - axis);
    if (ahead <= 0.0 && behind <= 0.0) {
        return vec3(0);
    }
    bool forward = behind <= 0.0;
    if (ahead > 0.0 && behind > 0.0) {
        const vec2 first = 1.0 / vec2(ahead, behind);
        const vec2 second = vec2(seenAt(texel + 2 * axis), seenAt(texel - 2 * axis));
        const vec2 change = abs(first - 1.0 / depth);
        const vec2 bend = mix(vec2(1e9), abs(2.0 * first - 1.0 / second - 1.0 / depth), greaterThan(second, vec2(0)));
        forward = min(bend.x, bend.y) < min(change.x, change.y) ? bend.x < bend.y : change.x < change.y;
    }
    const ivec2 to = forward ? axis : -axis;
    const float change = (forward ? ahead : behind) - depth;
    const vec2 slope = vec2(to) * 2.0 / (seen_limits.zw * seen_lens.xy);
    if (abs(change) > 32.0 * depth * length(slope)) {
        return vec3(0);
    }
    const vec3 tangent = change * seenRay(texel + to) + vec3(depth * slope, 0);
    return forward ? tangent : -tangent;
}

vec3 seenEye(vec3 x) {
    return vec3(dot(seen_row[0].xyz, x) + seen_row[0].w, dot(seen_row[1].xyz, x) + seen_row[1].w,
                dot(seen_row[2].xyz, x) + seen_row[2].w);
}

// In texels of the image; z = depth, 0 outside of the view.
vec3 seenPlace(vec3 eye) {
    const float depth = -eye.z;
    if (isBad(eye) || depth < seen_limits.x) {
        return vec3(0);
    }
    const vec2 place = ((seen_lens.xy * (eye.xy / depth) - seen_lens.zw) * 0.5 + 0.5) * seen_limits.zw;
    const bool beside = place.x < 0.0 || place.y < 0.0 || place.x >= seen_limits.z || place.y >= seen_limits.w;
    return beside ? vec3(0) : vec3(place, depth);
}

SeenPlane seenPlane(vec3 x) {
    const SeenPlane nothing = SeenPlane(vec3(0, 1, 0), 1e9, 0.0, 0.0, 0.0);
    const vec3 eye = seenEye(x);
    const vec3 at = seenPlace(eye);
    if (at.z == 0.0) {
        return nothing;
    }
    const float depth = at.z;
    const ivec2 texel = ivec2(at.xy);
    const float surface = seenAt(texel);
    if (surface <= 0.0) {
        return nothing;
    }
    const vec3 place = surface * seenRay(texel);
    const vec3 to_eye = -normalize(place);
    const vec3 across = seenTangent(texel, ivec2(1, 0), surface);
    const vec3 up = seenTangent(texel, ivec2(0, 1), surface);
    const bool has_across = dot(across, across) > 0.0;
    const bool has_up = dot(up, up) > 0.0;
    vec3 normal = to_eye;
    if (has_across && has_up) {
        normal = normalize(cross(normalize(across), normalize(up)));
        normal = dot(normal, to_eye) < 0.0 ? -normal : normal;
    } else if (has_across || has_up) {
        const vec3 tangent = normalize(has_across ? across : up);
        normal = normalize(to_eye - dot(to_eye, tangent) * tangent);
    }
    // The sine of the angle at which the plane is seen, but for the length of the ray: below 1/4 a quarter of the way
    // along the ray counts as the distance, so that nothing far in front of a silhouette or behind it is touched.
    const float facing = max(-dot(normal, eye) / depth, 1.0 / 64.0);
    const vec2 texel_size = 2.0 * surface / abs(seen_limits.zw * seen_lens.xy);
    return SeenPlane(normal.x * seen_row[0].xyz + normal.y * seen_row[1].xyz + normal.z * seen_row[2].xyz,
                     dot(normal, eye - place), max(1.0, 0.25 / facing), p.low.w * max(facing, 0.25),
                     max(p.low.w, max(texel_size.x, texel_size.y)));
}

bool hiddenBehind(SeenPlane plane) { return plane.distance * plane.stretch < -plane.reach; }

// For adhesion: xyz = unit normal towards the eye, w = distance to it. For who is hidden there is no wall. It takes no part
// in densities: it is known of one texel alone, and what changes from texel to texel would drive the fluid.
vec4 distanceToSeen(vec3 x) {
    const SeenPlane plane = seenPlane(x);
    return plane.stretch == 0.0 || hiddenBehind(plane) ? vec4(0, 1, 0, 1e9)
                                                       : vec4(plane.normal, plane.distance * plane.stretch);
}

bool hiddenAt(vec3 x) {
    const SeenPlane plane = seenPlane(x);
    return plane.stretch != 0.0 && hiddenBehind(plane);
}

// Where a step starts: whom the surface has come over is taken to it by up to a quarter of a radius, which is no
// velocity, but drives the fluid in front of it. Not to where it would be hidden, as in the corner of two surfaces.
vec3 rescuedFromSeen(vec3 x) {
    const SeenPlane plane = seenPlane(x);
    if (plane.stretch == 0.0 || hiddenBehind(plane) || plane.distance >= 0.0) {
        return x;
    }
    const vec3 to = x + plane.normal * min(-plane.distance, 0.25 * p.low.w);
    return hiddenAt(to) ? x : to;
}

// Who was in front stays a radius away from it along the view, or as near to it as `start` was; who was hidden stays so,
// half a radius deeper than who is in it, or rounding would take it in: what is taken back is never more than the way from there.
vec3 keptBySeen(SeenPlane plane, vec3 x, vec3 start) {
    const float before = (plane.distance + dot(plane.normal, start - x)) * plane.stretch;
    const float distance = plane.distance * plane.stretch;
    const float way = before < -plane.reach ? min(max(-plane.reach - 0.5 * p.low.w, before) - distance, 0.0)
                                            : max(min(plane.level, before) - distance, 0.0);
    return x + plane.normal * (way / plane.stretch);
}

// Whether x is hidden, and within the thickness of what hides it.
bool shutIn(vec3 x) {
    const SeenPlane plane = seenPlane(x);
    return plane.stretch != 0.0 && hiddenBehind(plane) &&
           -plane.distance * plane.stretch < max(seen_limits.y, 2.0 * plane.reach);
}

// Back over the plane through the eye and a border of a texel, onto the side of `texel`; axis 0 is across, 1 up.
vec3 overBorder(vec3 x, int texel, int axis) {
    const vec3 eye = seenEye(x);
    const bool below = seenPlace(eye)[axis] < float(texel);
    const float border = float(texel) + (below ? 0.01 : 0.99);
    const float slope = (border * 2.0 / seen_limits[2 + axis] - 1.0 + seen_lens[2 + axis]) / seen_lens[axis];
    const vec3 normal = seen_row[axis].xyz + slope * seen_row[2].xyz;
    return x - normal * ((eye[axis] + slope * eye.z) / (1.0 + slope * slope));
}

// x, which is hidden, where it would be seen by the texels that `start` is seen by: along as little of the image's axes as will do.
vec3 broughtBack(vec3 x, vec3 start) {
    const ivec2 texel = ivec2(seenPlace(seenEye(start)).xy);
    const bvec2 off = notEqual(texel, ivec2(seenPlace(seenEye(x)).xy));
    const vec3 across = off.x ? overBorder(x, texel.x, 0) : x;
    const vec3 up = off.y ? overBorder(x, texel.y, 1) : x;
    const bool by_across = off.x && !hiddenAt(across);
    const bool by_up = off.y && !hiddenAt(up);
    if (by_across && !(by_up && distance(up, x) < distance(across, x))) {
        return across;
    }
    return by_up || !off.x ? up : off.y ? overBorder(across, texel.y, 1) : across;
}

// Who was seen does not get into what is seen from its sides either.
vec3 collidedWithSeen(vec3 x, vec3 start) {
    const SeenPlane plane = seenPlane(x);
    if (plane.stretch == 0.0) {
        return x;
    }
    const vec3 kept = keptBySeen(plane, x, start);
    if (kept == x && !hiddenBehind(plane)) {
        return x;
    }
    if (seenPlace(seenEye(start)).z == 0.0 || !shutIn(kept) || hiddenAt(start)) {
        return kept;
    }
    const vec3 back = broughtBack(kept, start);
    const SeenPlane there = seenPlane(back);
    const vec3 to = there.stretch == 0.0 ? back : keptBySeen(there, back, start);
    return shutIn(to) ? start : to;
}

#endif
