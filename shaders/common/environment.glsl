// SPDX-License-Identifier: MIT
// Reading the latitude-longitude map: rows from the zenith down, column 0 looks along -z, columns turn towards +x.
#ifndef SLUICE_ENVIRONMENT_GLSL
#define SLUICE_ENVIRONMENT_GLSL

const float PI = 3.14159265358979;

// Bilinear, wrapping around the seam and held at the poles; linear radiance for a unit world direction.
vec3 environmentAt(texture2D map, vec3 direction) {
    const ivec2 size = textureSize(map, 0);
    const float longitude = atan(direction.x, -direction.z) / (2.0 * PI);
    const float latitude = acos(clamp(direction.y, -1.0, 1.0)) / PI;
    const vec2 at = vec2(longitude, latitude) * vec2(size) - vec2(0.0, 0.5);
    const ivec2 low = ivec2(floor(at));
    const vec2 f = at - vec2(low);
    const int left = (low.x + size.x) % size.x;
    const int right = (left + 1) % size.x;
    const int upper = clamp(low.y, 0, size.y - 1);
    const int lower = clamp(low.y + 1, 0, size.y - 1);
    const vec3 top = mix(texelFetch(map, ivec2(left, upper), 0).rgb, texelFetch(map, ivec2(right, upper), 0).rgb, f.x);
    const vec3 bottom = mix(texelFetch(map, ivec2(left, lower), 0).rgb, texelFetch(map, ivec2(right, lower), 0).rgb, f.x);
    return mix(top, bottom, f.y);
}

#endif
