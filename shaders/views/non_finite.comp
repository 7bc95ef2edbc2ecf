#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/views/views.h"

// Pixels that are NaN or infinite in magenta over the picture. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    vec3 light = radiance[pixel];
    if (any(isnan(light)) || any(isinf(light)))
        radiance[pixel] = vec3(1.0, 0.0, 1.0);
    else
        radiance[pixel] = groundColor(light, params.exposure, params.curve);
}
