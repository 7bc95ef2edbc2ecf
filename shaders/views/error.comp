#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/views/views.h"

// How far each pixel is from the nearest one of a reference: the largest difference of a channel over the reference's
// largest channel. What is not finite, in either, is magenta. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ErrorViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Sum { vec3 sum[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Reference { vec3 reference[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Colors { vec3 colors[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    uvec2 at = uvec2(pixel % params.width, pixel / params.width);
    uvec2 there = (2u * at + 1u) * uvec2(params.reference_width, params.reference_height) /
                  (2u * uvec2(params.width, params.height));
    vec3 want = reference[there.y * params.reference_width + there.x];
    float error = maxComponent(abs(params.scale * sum[pixel] - want)) / max(maxComponent(want), params.floor_);
    if (isnan(error) || isinf(error))
        colors[pixel] = vec3(1.0, 0.0, 1.0);
    else
        colors[pixel] = heatColor(1.0 - log(max(error, kLeastError)) / log(kLeastError));
}
