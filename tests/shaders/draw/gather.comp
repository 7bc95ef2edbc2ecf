#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/gather_ray.glsl"
#include "tests/shaders/draw/draw.h"

// A gathering ray of each of many samples, whose sequences are independent.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { DrawParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Draws { DirectionDraw draws[]; };

const uint kRays = 64u; // of a sample

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    vec3 direction = frameAround(params.point) * cosineDirection(gatherPair(i, i % kRays, kRays, params.seed));
    draws[i] = DirectionDraw(direction, dot(direction, params.point) * kInvPi);
}
