// SPDX-License-Identifier: MIT
// The sRGB transfer function, IEC 61966-2-1, per channel on [0,1].
#ifndef SLUICE_SRGB_GLSL
#define SLUICE_SRGB_GLSL

vec3 srgbDecode(vec3 encoded) {
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

vec3 srgbEncode(vec3 linear) {
    const vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, c * 12.92, lessThanEqual(c, vec3(0.0031308)));
}

#endif
