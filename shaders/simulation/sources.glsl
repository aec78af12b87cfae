// SPDX-License-Identifier: MIT
// Force fields, drains and outlets; mirrors SourceBlock of renderer_vk/src/simulation/sources.hpp. The including file
// defines SOURCES_BINDING.
#ifndef SLUICE_SOURCES_GLSL
#define SLUICE_SOURCES_GLSL

struct Field {
    vec4 centre;  // w = kind: wind, point, vortex
    vec4 axis;    // unit; w = strength, m/s^2
    vec4 reach;   // x = 1 / radius, or 0: everywhere the same
};
struct Sink {
    vec4 centre;  // w = 1: sphere, 0: box along the axes
    vec4 half_;   // x = radius of a sphere
};
struct Outlet {
    vec4 around;   // a ball that holds this step's births and what could be in their way
    uvec4 births;  // x = first, y = end
};
layout(std140, set = 0, binding = SOURCES_BINDING) uniform Sources {
    uvec4 number;  // x = fields, y = drains, z = outlets
    Field field[16];
    Sink drain[16];
    Outlet outlet[16];
} s;

// m/s^2, of all fields.
vec3 fieldsAt(vec3 x) {
    vec3 sum = vec3(0);
    for (uint k = 0u; k < s.number.x; ++k) {
        const Field f = s.field[k];
        const uint kind = uint(f.centre.w);
        vec3 away = x - f.centre.xyz;
        if (kind == 2u) {
            away -= dot(away, f.axis.xyz) * f.axis.xyz;
        }
        const float distance_ = length(away);
        const float q = distance_ * f.reach.x;
        const float weight = max(1.0 - q * q, 0.0);
        vec3 direction = f.axis.xyz;
        if (kind != 0u) {
            // On the point, or on the axis, there is no direction.
            const vec3 out_ = distance_ > 1e-6 ? away / distance_ : vec3(0);
            direction = kind == 1u ? -out_ : cross(f.axis.xyz, out_);
        }
        sum += direction * (f.axis.w * weight * weight);
    }
    return sum;
}

bool drained(vec3 x) {
    for (uint k = 0u; k < s.number.y; ++k) {
        const vec3 away = x - s.drain[k].centre.xyz;
        const vec3 half_ = s.drain[k].half_.xyz;
        if (s.drain[k].centre.w == 1.0 ? dot(away, away) < half_.x * half_.x : all(lessThan(abs(away), half_))) {
            return true;
        }
    }
    return false;
}

#endif
