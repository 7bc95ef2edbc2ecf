#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/views/views.h"

// Irradiance samples as dots over the picture. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Marks { uint marks[]; };
layout(set = 1, binding = 1, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel < params.width * params.height)
        radiance[pixel] = marks[pixel] != 0u ? vec3(1.0, 0.6, 0.0) : groundColor(radiance[pixel], params.exposure, params.curve);
}
