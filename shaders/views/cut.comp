#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/lib/shading_point.glsl"
#include "shaders/views/views.h"

// Every shading point in the colour of the cut node that is nearest on its surface. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer CutSize { QueueSize cut_size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer CutNodes;
layout(set = 1, binding = 3, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
#include "shaders/lib/cut.glsl"

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    vec3 color = groundColor(radiance[pixel], params.exposure, params.curve);
    if (points[pixel].slot != kNone)
    {
        Surface s = surfaceAt(points[pixel]);
        uint node = nearestCutNode(s.position, s.geometric_normal, kInfinity);
        if (node != kNone)
            color = indexColor(node);
    }
    radiance[pixel] = color;
}
