// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
// The fluid's colour, coverage and window depth, and what else the host reads.
// Inputs:  filtered depth, normals, thickness (metres, reduced resolution) and, of several looks, optical depth, HOST_COLOUR (sRGB-encoded), HOST_DEPTH, the
//          environment map or the procedural sky. Eye space; light is linear until the last line.
// Outputs: FLUID_COLOUR (sRGB-encoded, not premultiplied, alpha = coverage), FLUID_DEPTH (window depth, 1 = no fluid),
//          FLUID_NORMAL, FLUID_THICKNESS. An output that the host does not read is a placeholder and not written.
//          Foam, metres along the ray (reduced resolution), covers the water.
// Inputs that a specialisation constant switches off are placeholders and not read.
// Bound of its test: colour 2e-3 (more under a steep highlight), window depth 1e-6, against the formulas in double precision
// over a flat background. Coverage and the refracted position have no reference; their tests are by property.
#include "environment.glsl"
#include "sky.glsl"
#include "srgb.glsl"
#include "tiles.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(constant_id = 0) const uint VIEW = 0u;           // SluiceView
layout(constant_id = 1) const uint HAS_NORMALS = 1u;
layout(constant_id = 2) const uint HAS_THICKNESS = 1u;
layout(constant_id = 3) const uint REFRACTION = 1u;
layout(constant_id = 4) const uint REFLECTION = 1u;     // 0 none, 1 procedural sky, 2 map
layout(constant_id = 5) const uint WRITE_NORMAL = 0u;
layout(constant_id = 6) const uint WRITE_THICKNESS = 0u;
layout(constant_id = 7) const uint FOAM = 0u;
layout(constant_id = 8) const uint SEVERAL = 0u;        // looks: what is absorbed is in optical_in

layout(set = 0, binding = 2) uniform texture2D depth_in;
layout(set = 0, binding = 3) uniform texture2D host_depth;
layout(set = 0, binding = 4) uniform texture2D normal_in;
layout(set = 0, binding = 5) uniform texture2D thickness_in;
layout(set = 0, binding = 6) uniform texture2D host_colour;
layout(set = 0, binding = 7) uniform texture2D environment;
layout(set = 0, binding = 8) writeonly uniform image2D fluid_colour;
layout(set = 0, binding = 9) writeonly uniform image2D fluid_depth;
layout(set = 0, binding = 10) writeonly uniform image2D fluid_normal;
layout(set = 0, binding = 11) writeonly uniform image2D fluid_thickness;
layout(set = 0, binding = 12) uniform texture2D foam_in;
layout(set = 0, binding = 13) uniform texture2D optical_in;

const float FOAM_ALBEDO = 0.85;
// Irradiance over pi by a sun of radiance 1: that of the default sun (60) lights white to 0.8, twice as much as its sky.
const float FOAM_SUN = 0.013;
const uint VIEW_FLUID = 0u, VIEW_DEPTH = 1u, VIEW_NORMAL = 2u, VIEW_THICKNESS = 3u;

ivec2 onScreen(ivec2 texel) { return clamp(texel, ivec2(0), ivec2(frame.size.xy) - 1); }

// Metres of fluid along the ray through a texel of the full resolution, in w: bilinear over the texels that have any, so that
// the outline is not thinned by the nothing beside it. Of several looks their optical depth likewise, in xyz.
vec4 fluidAt(ivec2 texel) {
    const ivec2 size = textureSize(thickness_in, 0);
    const vec2 at = (vec2(texel) + 0.5) / frame.thickness.x - 0.5;
    const ivec2 low = ivec2(floor(at));
    const vec2 f = at - vec2(low);
    float sum = 0.0;
    float weights = 0.0;
    vec3 optical = vec3(0.0);
    for (int corner = 0; corner < 4; ++corner) {
        const ivec2 offset = ivec2(corner & 1, corner >> 1);
        const ivec2 from = clamp(low + offset, ivec2(0), size - 1);
        const float value = texelFetch(thickness_in, from, 0).r;
        const vec2 w = mix(1.0 - f, f, vec2(offset));
        sum += w.x * w.y * value;
        weights += value > 0.0 ? w.x * w.y : 0.0;
        if (SEVERAL != 0u) {
            optical += w.x * w.y * texelFetch(optical_in, from, 0).rgb;
        }
    }
    return weights > 0.0 ? vec4(optical, sum) / weights : vec4(0.0);
}

// Metres of foam along the ray through a texel of the full resolution: bilinear, and where there is none it is none.
float foamAt(ivec2 texel) {
    const ivec2 size = textureSize(foam_in, 0);
    const vec2 at = (vec2(texel) + 0.5) / frame.thickness.x - 0.5;
    const ivec2 low = ivec2(floor(at));
    const vec2 f = at - vec2(low);
    float sum = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
        const ivec2 offset = ivec2(corner & 1, corner >> 1);
        const vec2 w = mix(1.0 - f, f, vec2(offset));
        sum += w.x * w.y * texelFetch(foam_in, clamp(low + offset, ivec2(0), size - 1), 0).r;
    }
    return sum;
}

// How much the foam of a pixel hides of the water.
float foamCover(ivec2 texel) {
    return 1.0 - exp(-uintBitsToFloat(frame.modes.w) * foamAt(texel) / (2.0 * particleRadius()));
}

// What foam looks like: white that scatters the sky, half of it the horizon's, and the sun, which its bubbles lead round
// their own shadows (wrapped Lambert).
vec3 foamLight(vec3 normal) {
    const vec3 up = normalize(normal * mat3(frame.view) + vec3(0.0, 1.0, 0.0));
    const float sun = max(0.25 + 0.75 * dot(normal, frame.to_sun.xyz), 0.0);
    return FOAM_ALBEDO * (0.5 * (skyWithoutSun(up) + frame.horizon.rgb) + sun * FOAM_SUN * frame.sun_radiance.rgb);
}

// How much of the pixel the outline leaves to the fluid, from the 3x3 texels around it (binomial weights): one pixel of
// softness on the inside, at every distance.
float outlineCoverage(ivec2 texel) {
    float inside = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            const float weight = float((2 - abs(x)) * (2 - abs(y))) / 16.0;
            inside += isEmpty(texelFetch(depth_in, onScreen(texel + ivec2(x, y)), 0).r) ? 0.0 : weight;
        }
    }
    return smoothstep(0.0, 1.0, inside);
}

vec3 hostLinear(ivec2 texel) { return srgbDecode(texelFetch(host_colour, onScreen(texel), 0).rgb); }

// What is nearest in HOST_DEPTH, as it is there, around the four texels from `low` on: of each with its eight neighbours.
vec4 nearestAround(ivec2 low) {
    vec4 nearest = vec4(EMPTY_DEPTH);
    for (int row = -1; row <= 2; ++row) {
        const float a = texelFetch(host_depth, onScreen(low + ivec2(-1, row)), 0).r;
        const float b = texelFetch(host_depth, onScreen(low + ivec2(0, row)), 0).r;
        const float c = texelFetch(host_depth, onScreen(low + ivec2(1, row)), 0).r;
        const float d = texelFetch(host_depth, onScreen(low + ivec2(2, row)), 0).r;
        const float between = min(b, c);
        const vec2 pair = vec2(min(a, between), min(between, d));
        nearest.xy = row < 2 ? min(nearest.xy, pair) : nearest.xy;
        nearest.zw = row > -1 ? min(nearest.zw, pair) : nearest.zw;
    }
    return nearest;
}

// The scene behind the fluid, seen where a ray leaves it. Texels whose scene is in front of the fluid (a pillar's edge)
// have nothing to do with what is behind it, nor have those beside them: where an engine smooths its edges, by several
// samples a pixel for one, their colour is a mixture of both sides and their depth that of one. Where such would take
// part, half the offset is tried, then a quarter, then none, each blended in as far as the one before failed, so that
// neither ghosts nor steps appear.
vec3 background(ivec2 texel, vec2 pixel, float depth) {
    const vec2 centre = vec2(texel) + 0.5;
    vec3 colour = vec3(0.0);
    float missing = 1.0;
    float reach = 1.0;
    for (int attempt = 0; attempt < 3 && missing > 0.0; ++attempt) {
        const vec2 at = clamp(mix(centre, pixel, reach), vec2(0.5), frame.size.xy - 0.5) - 0.5;
        const ivec2 low = ivec2(floor(at));
        const vec2 f = at - vec2(low);
        const vec4 nearest = nearestAround(low);
        vec3 sum = vec3(0.0);
        float found = 0.0;
        for (int corner = 0; corner < 4; ++corner) {
            const ivec2 offset = ivec2(corner & 1, corner >> 1);
            const vec2 w = mix(1.0 - f, f, vec2(offset));
            const float behind = w.x * w.y * smoothstep(0.0, particleRadius(), sceneDepth(nearest[corner]) - depth);
            sum += behind * hostLinear(low + offset);
            found += behind;
        }
        colour += missing * sum;
        missing *= max(1.0 - found, 0.0);
        missing = missing < 1e-3 ? 0.0 : missing;
        reach *= 0.5;
    }
    return missing > 0.0 ? colour + missing * hostLinear(texel) : colour;
}

float schlick(float f0, float cosine) {
    const float k = 1.0 - clamp(cosine, 0.0, 1.0);
    return f0 + (1.0 - f0) * k * k * k * k * k;
}

// Linear colour and opacity of the fluid in front of whatever is behind it. `path` is metres of fluid along the ray,
// `absorbed` their optical depth.
vec4 shadeFluid(ivec2 texel, vec3 ray, float depth, vec3 normal, float path, vec3 absorbed) {
    const float ior = frame.absorption.w;
    const vec3 to_eye = -normalize(ray);
    const float f0 = ((ior - 1.0) / (ior + 1.0)) * ((ior - 1.0) / (ior + 1.0));
    const float cosine = dot(normal, to_eye);

    vec3 mirrored = vec3(0.0);
    float fresnel = 0.0;
    if (REFLECTION != 0u) {
        fresnel = schlick(f0, cosine);
        // The view is a rotation and a translation: its transpose turns eye directions into world directions.
        const vec3 direction = normalize(reflect(-to_eye, normal) * mat3(frame.view));
        mirrored = REFLECTION == 2u ? environmentAt(environment, direction) : skyWithoutSun(direction);
    }
    const vec3 halfway = normalize(to_eye + frame.to_sun.xyz);
    const float lobe = dot(normal, frame.to_sun.xyz) > 0.0
                           ? pow(max(dot(normal, halfway), 1e-6), frame.scatter.w) * schlick(f0, dot(to_eye, halfway))
                           : 0.0;
    const vec3 surface = fresnel * mirrored + lobe * frame.sun_radiance.rgb;

    const vec3 transmitted = exp(-absorbed);
    const vec3 scattered = (1.0 - fresnel) * frame.scatter.rgb * (1.0 - transmitted);
    if (REFRACTION == 0u) {
        // The host's blend supplies the background, so that the opacity stands for what it cannot: one number for the
        // three channels' transmission.
        const float opacity = 1.0 - (1.0 - fresnel) * dot(transmitted, vec3(1.0 / 3.0));
        return vec4((surface + scattered) / max(opacity, 1.0 / 255.0), opacity);
    }
    const vec3 exit = depth * ray + path * refract(-to_eye, normal, 1.0 / ior);
    const vec2 pixel = exit.z < -nearPlane() ? pixelOf(exit) : vec2(texel) + 0.5;
    return vec4(surface + scattered + (1.0 - fresnel) * transmitted * background(texel, pixel, depth), 1.0);
}

void main() {
    const ivec2 texel = tileTexel();
    if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) {
        return;
    }
    const float depth = texelFetch(depth_in, texel, 0).r;
    const float scene = sceneDepth(texelFetch(host_depth, texel, 0).r);
    if (isEmpty(depth) || scene <= depth) {
        imageStore(fluid_colour, texel, vec4(0.0));
        imageStore(fluid_depth, texel, vec4(1.0));
        if (WRITE_NORMAL != 0u) {
            imageStore(fluid_normal, texel, vec4(0.0));
        }
        if (WRITE_THICKNESS != 0u) {
            imageStore(fluid_thickness, texel, vec4(0.0));
        }
        return;
    }
    const vec3 ray = rayThrough(vec2(texel) + 0.5);
    const float to_scene = (scene - depth) * length(ray);
    vec3 normal = vec3(0.0, 0.0, 1.0);
    if (HAS_NORMALS != 0u) {
        normal = normalize(texelFetch(normal_in, texel, 0).xyz);
    }
    float path = 0.0;
    vec3 absorbed = vec3(0.0);
    if (HAS_THICKNESS != 0u) {
        const vec4 fluid = fluidAt(texel);
        path = min(fluid.w, to_scene);
        // What lies behind the scene absorbs nothing: as much of each as of their metres.
        absorbed = SEVERAL == 0u ? frame.absorption.rgb * path : fluid.w > 0.0 ? fluid.xyz * (path / fluid.w) : vec3(0.0);
    }

    vec4 colour = vec4(0.0, 0.0, 0.0, 1.0);
    if (VIEW == VIEW_FLUID) {
        vec4 shaded = shadeFluid(texel, ray, depth, normal, path, absorbed);
        if (FOAM != 0u) {
            const float cover = foamCover(texel);
            const float alpha = mix(shaded.a, 1.0, cover);
            shaded = vec4(mix(shaded.rgb * shaded.a, foamLight(normal), cover) / max(alpha, 1.0 / 255.0), alpha);
        }
        // Half a radius of softness where the surface runs into the scene.
        const float shore = smoothstep(0.0, 0.5 * particleRadius(), to_scene);
        colour = vec4(srgbEncode(shaded.rgb), shaded.a * shore * outlineCoverage(texel));
    } else if (VIEW == VIEW_DEPTH) {
        // White at the near plane, black at the far plane, even steps for even ratios.
        colour.rgb = vec3(clamp(log(farPlane() / depth) / log(farPlane() / nearPlane()), 0.0, 1.0));
    } else if (VIEW == VIEW_NORMAL) {
        colour.rgb = normal * 0.5 + 0.5;
    } else {
        // Half grey at ten radii of fluid.
        colour.rgb = vec3(path / (path + 10.0 * particleRadius()));
    }
    imageStore(fluid_colour, texel, colour);
    imageStore(fluid_depth, texel, vec4(windowDepth(depth)));
    if (WRITE_NORMAL != 0u) {
        imageStore(fluid_normal, texel, vec4(normal, 1.0));
    }
    if (WRITE_THICKNESS != 0u) {
        imageStore(fluid_thickness, texel, vec4(path));
    }
}
