#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/guide/guide.h"
#include "tests/shaders/draw/draw.h"
#include "tests/shaders/draw/independent.glsl"

// Cells of a learned distribution.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { DrawParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) readonly buffer Distribution { GuideDistribution distribution; };
layout(set = 1, binding = 2, scalar) writeonly buffer Draws { CellDraw draws[]; };
#include "shaders/lib/guide.glsl"

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Sampler s = independentSampler(params.seed, i);
    float u = nextPair(s).x;
    uint cell = pickCell(u);
    draws[i] = CellDraw(cell, u);
}
