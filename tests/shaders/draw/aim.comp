#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/aim.glsl"
#include "shaders/lib/random.glsl"
#include "tests/shaders/draw/draw.h"

// Pairs warped towards where light comes from according to the path segments (legs), in the limit of infinitely many.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { DrawParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Counts { uint counts[]; }; // by cell
layout(set = 1, binding = 1, scalar) writeonly buffer Draws { PairDraw draws[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x, thread = gl_LocalInvocationID.x;
    for (uint c = thread; c < kAimCells; c += kDrawGroupSize)
        aim_counts[c] = counts[c];
    aim_sums[thread] = vec2(1.0, 0.0);
    barrier();
    distributeAim(thread);
    if (i >= params.count)
        return;
    Sampler sampler_ = Sampler(hash(params.seed, i), 0u, 0u); // independent draws
    float weight;
    vec2 pair = aimPair(nextPair(sampler_), weight);
    draws[i] = PairDraw(pair, weight, aimCell(cosineDirection(pair)));
}
