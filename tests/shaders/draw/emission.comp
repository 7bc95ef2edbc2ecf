#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/emission.glsl"
#include "tests/shaders/draw/draw.h"
#include "tests/shaders/draw/independent.glsl"

// How photons leave the lights.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { DrawParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Draws { PhotonStart draws[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Sampler s = independentSampler(params.seed, i);
    Emission emission = emitPhoton(params.aim, s);
    draws[i] = PhotonStart(emission.origin, emission.direction, emission.power);
}
