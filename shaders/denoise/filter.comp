#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/denoise/denoise.h"
#include "shaders/lib/signal.glsl"
#include "shaders/lib/tile.glsl"

// One pass of an edge-avoiding wavelet filter (Dammertz et al. 2010): each pixel becomes the weighted mean of nine, `step_`
// pixels apart. Light and reflectance get the same weights, so that their ratio is the light around, textures left out. The
// first pass estimates the noise where no history tells it; where it is known, passes take a difference in brightness beyond the noise for one in the scene (Schied
// et al. 2017, "Spatiotemporal Variance-Guided Filtering"). One thread per pixel.

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

void main()
{
    uint pixel = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
    if (pixel >= params.point_count)
        return;
    Signal center = unpackSignal(texelFetch(Signals, int(pixel)));
    if (center.lobe == 0.0 || (center.error >= 0.0 && center.error <= kUnseen * brightness(center)))
    {
        filtered[pixel] = packSignal(center);
        return;
    }
    Guide guide = loadGuide(pixel);
    float bright = brightness(center), weights = 1.0, squares = 1.0;
    float mean = bright, mean2 = bright * bright, variance = square(max(center.error, 0.0));
    Signal sum = center;
    ivec2 size = ivec2(params.width, params.point_count / params.width), at = ivec2(pixel % params.width, pixel / params.width);
    for (int k = 0; k < 9; ++k)
    {
        ivec2 offset = ivec2(k % 3, k / 3) - 1, place = at + offset * int(params.step_);
        if (offset == ivec2(0) || any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))
            continue;
        uint neighbour = uint(place.y * size.x + place.x);
        Signal other = unpackSignal(texelFetch(Signals, int(neighbour)));
        float steps2 = dot(offset, offset), other_bright = brightness(other);
        if (other.lobe == 0.0 || isnan(other_bright) || isinf(other_bright))
            continue; // one bad sample must not spread
        float weight = exp2(-0.5 * steps2) * edgeStoppingWeight(guide, loadGuide(neighbour), center.lobe, other.lobe,
                                                      float(params.step_) * sqrt(steps2));
        if (params.step_ > 1u || center.error >= 0.0)
            weight *= exp(-abs(other_bright - bright) /
                          (kBeyondNoise * sqrt(square(center.error) + square(max(other.error, 0.0))) + 1e-20));
        sum.light += weight * other.light;
        sum.reflectance += weight * other.reflectance;
        weights += weight;
        squares += weight * weight;
        mean += weight * other_bright;
        mean2 += weight * square(other_bright);
        variance += square(weight * max(other.error, 0.0));
    }
    sum.light /= weights;
    sum.reflectance /= weights;
    if (params.step_ == 1u && center.error < 0.0)
        variance = max(0.0, mean2 / weights - square(mean / weights)) * squares;
    sum.error = sqrt(variance) / weights;
    filtered[pixel] = packSignal(sum);
}
