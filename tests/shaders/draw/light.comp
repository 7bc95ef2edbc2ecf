#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/lights.glsl"
#include "tests/shaders/draw/draw.h"
#include "tests/shaders/draw/independent.glsl"

// Lights and places on them that light sampling chooses for a point.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { DrawParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Draws { LightDraw draws[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Sampler s = independentSampler(params.seed, i);
    LightSample light = sampleLight(params.point, s);
    draws[i] = LightDraw(light.wi, light.pdf, light.weight, light.distance);
}
