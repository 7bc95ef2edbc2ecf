#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/false_color.glsl"
#include "shaders/lib/shading_point.glsl"
#include "shaders/views/views.h"

// Normals or positions of the shading points. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.width * params.height)
        return;
    vec3 color = vec3(0.0);
    if (points[pixel].slot != kNone)
    {
        Surface s = surfaceAt(points[pixel]);
        vec3 extent = max(scene.bounds_max - scene.bounds_min, 1e-20);
        color = params.view == kViewNormals ? 0.5 * s.normal + 0.5 : clamp((s.position - scene.bounds_min) / extent, 0.0, 1.0);
    }
    radiance[pixel] = fromSrgb(color);
}
