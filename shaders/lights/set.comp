#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lights/lights.h"

// Writes lights that change, and the probabilities that all of them have then. A thread does one of each.

layout(local_size_x = kSetLightsGroupSize) in;
layout(push_constant, scalar) uniform Params { SetLightsParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Changes { SetLight changes[]; }; // each of another light
layout(set = 1, binding = 1, scalar) readonly buffer Probabilities { float probabilities[]; };
layout(set = 1, binding = 2, scalar) buffer Lights { Light lights[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < params.pmf_count)
        lights[i].pmf = probabilities[i];
    if (i >= params.change_count)
        return;
    SetLight change = changes[i];
    lights[change.light].emission = change.emission;
    if (lights[change.light].kind == kLightTriangle || lights[change.light].kind == kLightTriangleTwoSided)
        return;
    lights[change.light].p0 = change.p0;
    lights[change.light].p1 = change.p1;
    lights[change.light].p2 = change.p2;
}
