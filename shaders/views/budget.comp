#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/samples/quadtree.glsl"
#include "shaders/views/views.h"

// The budgets of one level of the quadtree: none dark blue, an even share blue, fifteen times that yellow. One thread per
// pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { QuadViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Budgets { uint budgets[]; }; // by node
layout(set = 1, binding = 1, scalar) writeonly buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.view.width * params.view.height)
        return;
    uint point = zOrder(uvec2(pixel % params.view.width, pixel / params.view.width) / params.stride);
    uint budget = budgets[levelOffset(params.level, params.levels) + (point >> (2u * params.level))];
    radiance[pixel] = heatColor(0.25 * log2(1.0 + float(budget) / params.mean));
}
