#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/denoise/denoise.h"
#include "shaders/lib/signal.glsl"
#include "shaders/lib/tile.glsl"

// One pass of an edge-avoiding wavelet filter (Dammertz et al. 2010) in a form that keeps energy: light flows between pixels
// `step_` pixels apart, as much into one as out of the other, so that a rare bright sample is spread and none of it is lost.
// What evens out is light over reflectance, so that textures stay. The first pass estimates the noise where no history tells
// it; where it is known, passes take a difference in brightness beyond the noise for one in the scene (Schied et al. 2017,
// "Spatiotemporal Variance-Guided Filtering"). One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DenoiseParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Guides;
layout(set = 1, binding = 1) uniform usamplerBuffer Signals;
layout(set = 1, binding = 2, scalar) writeonly buffer Filtered { LightSignal filtered[]; };

const float kBend = 0.25;  // of a lobe's width: how far the direction it reflects from may turn, radians
const float kUnseen = 0.01;     // of the brightness: noise of which nothing is seen; what has a history that long is left as it is
const float kBeyondNoise = 2.0; // standard errors
const float kWider = 0.5;   // of a lobe's width: what makes another lobe of it
const float kOffPlane = 0.15; // sine of the angle to the surface at which another place is no more part of it
const float kAllWeights = 1.0 + 4.0 * 0.70710678 + 4.0 * 0.5; // of nine pixels on an even wall: then the pass is their mean

struct Guide
{
    vec3 position;
    vec3 smooth_normal;
    vec3 normal;
};

Guide loadGuide(uint pixel)
{
    uvec4 bits = texelFetch(Guides, int(pixel));
    vec4 normals = unpackSnorm4x8(bits.w);
    return Guide(uintBitsToFloat(bits.xyz), octahedralToUnit(normals.xy), octahedralToUnit(normals.zw));
}

/// The same for both pixels. @param pixels between them
float edgeStoppingWeight(Guide a, Guide b, float a_lobe, float b_lobe, float pixels)
{
    float lobe = min(a_lobe, b_lobe), wider = (max(a_lobe, b_lobe) - lobe) / lobe;
    vec3 d = b.position - a.position, turn = b.normal - a.normal;
    float off_plane = dot(a.smooth_normal + b.smooth_normal, d) * 0.5 * inversesqrt(max(dot(d, d), 1e-30));
    float bend2 = dot(turn, turn) + square(params.pixel_angle * pixels);
    return exp(-square(off_plane / kOffPlane) - square(wider / kWider) - bend2 / (2.0 * square(kBend * lobe)));
}

/// Light flows into and out of the pixel.
bool flows(Signal s)
{
    float bright = brightness(s);
    bool finite = !isnan(bright) && !isinf(bright); // one bad sample must not spread
    return s.lobe > 0.0 && finite && (s.error < 0.0 || s.error > kUnseen * bright);
}

/// The same for both pixels. 1: differences in brightness are no more than noise, or the noise of both is unknown.
float noiseWeight(Signal a, Signal b)
{
    if (max(a.error, b.error) < 0.0)
        return 1.0;
    float noise = length(max(vec2(a.error, b.error), vec2(0.0)));
    return exp(-abs(brightness(a) - brightness(b)) / (kBeyondNoise * noise + 1e-20));
}

void main()
{
    uint pixel = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
    if (pixel >= params.point_count)
        return;
    Signal center = unpackSignal(texelFetch(Signals, int(pixel)));
    if (!flows(center))
    {
        filtered[pixel] = packSignal(center);
        return;
    }
    Guide guide = loadGuide(pixel);
    float bright = brightness(center), weights = 1.0, mean = bright, mean2 = bright * bright;
    float left = 1.0, parts2 = 0.0, variance = 0.0; // parts of the center's brightness and of others' that make up the result
    vec3 light = center.light;
    uint row = quotient(pixel, params.width);
    ivec2 size = ivec2(params.width, quotient(params.point_count, params.width)), at = ivec2(pixel - row * params.width, row);
    [[unroll]] for (int k = 0; k < 9; ++k)
    {
        ivec2 offset = ivec2(k % 3, k / 3) - 1, place = at + offset * int(params.step_);
        if (offset == ivec2(0) || any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))
            continue;
        uint neighbour = uint(place.y * size.x + place.x);
        Signal other = unpackSignal(texelFetch(Signals, int(neighbour)));
        if (!flows(other))
            continue;
        float steps2 = dot(offset, offset), other_bright = brightness(other);
        float weight = exp2(-0.5 * steps2) * edgeStoppingWeight(guide, loadGuide(neighbour), center.lobe, other.lobe,
                                                      float(params.step_) * sqrt(steps2)) * noiseWeight(center, other);
        vec3 passed = weight / kAllWeights * min(center.reflectance, other.reflectance); // out of here and out of there
        light += passed * (other.light / other.reflectance - center.light / center.reflectance);
        float part = weight / kAllWeights * min(1.0, luminance(other.reflectance) / luminance(center.reflectance));
        left -= part;
        parts2 += square(part);
        variance += square(part * max(other.error, 0.0));
        weights += weight;
        mean += weight * other_bright;
        mean2 += weight * square(other_bright);
    }
    variance = center.error < 0.0 ? max(0.0, mean2 / weights - square(mean / weights)) * (parts2 + square(left))
                                  : variance + square(left * center.error);
    filtered[pixel] = packSignal(Signal(max(light, vec3(0.0)), center.reflectance, center.lobe, sqrt(variance)));
}
