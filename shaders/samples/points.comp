#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/samples/samples.h"

// Picks one shading point of every stride x stride block of pixels. One thread per point, in Z-order.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { PointParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 1, scalar) writeonly buffer Points { SamplePoint points[]; };
#include "shaders/lib/diffuse_point.glsl"

uint evenBits(uint x) // the inverse of spreading bits by one
{
    x &= 0x55555555u;
    x = (x | (x >> 1)) & 0x33333333u;
    x = (x | (x >> 2)) & 0x0f0f0f0fu;
    x = (x | (x >> 4)) & 0x00ff00ffu;
    return (x | (x >> 8)) & 0x0000ffffu;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length())
        return;
    uint random = hash(params.seed, i);
    uvec2 block = uvec2(evenBits(i), evenBits(i >> 1)) * params.stride;
    uvec2 pixel = block + uvec2(random & 0xffffu, random >> 16) % params.stride;
    bool outside = block.x >= params.width || block.y >= params.height;
    pixel = min(pixel, uvec2(params.width, params.height) - 1u);
    uint index = pixel.y * params.width + pixel.x;
    DiffusePoint point = loadDiffusePoint(index);
    bool takes_part = !outside && point.reflectance != vec3(0.0);
    points[i] = SamplePoint(point.position, packSnorm2x16(point.normal), takes_part ? index : kNone);
}
