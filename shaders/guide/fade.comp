#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/guide/guide.h"

// Adds this frame's estimates to those of the frames before, which fade. One thread per cell.

layout(local_size_x = kGuideGroupSize) in;
layout(push_constant, scalar) uniform Params { FadeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Largest { float largest; }; // of the values that estimates are sums of
layout(set = 1, binding = 1, scalar) buffer Estimates { GuideEstimate estimates[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Roots { float roots[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= kGuideTotal)
        return;
    GuideEstimate e = estimates[i];
    float now = (float(e.high) * 4294967296.0 + float(e.low)) / params.scale * square(largest);
    float sum = params.memory * e.before + now;
    estimates[i] = GuideEstimate(0u, 0u, sum);
    roots[i] = sqrt(sum);
}
