#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/samples/quadtree.glsl"
#include "shaders/views/views.h"

// Every pixel in the colour of the cluster that its block's point belongs to; samples are black. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { QuadViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Marks { uint marks[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Owners { uvec2 owners[]; }; // by point
layout(set = 1, binding = 2, scalar) buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.view.width * params.view.height)
        return;
    uint owner = owners[zOrder(uvec2(pixel % params.view.width, pixel / params.view.width) / params.stride)].x;
    if (marks[pixel] != 0u)
        radiance[pixel] = vec3(0.0);
    else
        radiance[pixel] = owner != kNone ? indexColor(owner) : groundColor(radiance[pixel], params.view.exposure, params.view.curve);
}
