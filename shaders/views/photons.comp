#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/views/views.h"

// Photons as dots over the picture, in the colour of their power. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Marks { uint marks[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 2, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    vec3 color = groundColor(radiance[pixel], params.exposure, params.curve);
    if (marks[pixel] != 0u)
    {
        vec3 power = photons[marks[pixel] - 1u].power;
        color = power / max(maxComponent(power), 1e-30);
    }
    radiance[pixel] = color;
}
