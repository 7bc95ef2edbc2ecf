#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/compose/compose.h"

// Adds up the terms of every pixel, of both its points. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ComposeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Emission { vec3 emission[]; };
layout(set = 1, binding = 1, scalar) readonly buffer SharpDirect { vec3 sharp_direct[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Direct { vec3 direct[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Glossy { vec3 glossy[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Picture { vec3 picture[]; };

bool has(uint term) { return (params.terms & term) != 0u; }

vec3 lightOf(uint point)
{
    vec3 sum = vec3(0.0);
    if (has(kLightEmission))
        sum += emission[point];
    if (has(kLightSharpDirect))
        sum += sharp_direct[point];
    if (has(kLightDirect))
        sum += direct[point];
    if (has(kLightIndirect))
        sum += indirect[point];
    if (has(kLightGlossy))
        sum += glossy[point];
    if (has(kLightCaustics))
        sum += caustics[point];
    return sum;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.pixel_count)
        return;
    vec3 sum = lightOf(pixel);
    if (params.point_count > params.pixel_count)
        sum += lightOf(params.pixel_count + pixel);
    picture[pixel] = sum;
}
