#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/views/views.h"

// Marks the pixel of every directly visible photon, of a uniform subset where there are many. One thread per
// photon.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { PhotonViewParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 3, scalar) buffer Marks { uint marks[]; }; // by pixel, 0 before: 1 + index of the photon

/// Where x is in the picture, in pixels. @return false behind the eye
bool project(vec3 x, out vec2 at)
{
    CameraParams camera = params.camera;
    vec3 d = x - camera.position;
    float depth = camera.orthographic != 0u ? 1.0 : dot(d, camera.forward);
    vec2 image = vec2(dot(d, camera.right) / dot(camera.right, camera.right), dot(d, camera.up) / dot(camera.up, camera.up)) / depth;
    at = (0.5 + vec2(0.5, -0.5) * image) * vec2(camera.width, camera.height);
    return depth > 0.0;
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    vec2 at;
    if (i >= size.count || i % (1u + size.count / params.most) != 0u || !project(photons[i].position, at))
        return;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, vec2(params.camera.width, params.camera.height))))
        return;
    uint pixel = uint(at.y) * params.camera.width + uint(at.x);
    if (points[pixel].slot == kNone || points[pixel].depth != 0u)
        return;
    // Of the surface seen there: no farther from its shading point than a few pixels are wide.
    vec3 seen = points[pixel].position;
    float pixel_width = 2.0 * length(params.camera.right) / float(params.camera.width);
    if (params.camera.orthographic == 0u)
        pixel_width *= length(seen - params.camera.position);
    if (length(photons[i].position - seen) < 8.0 * pixel_width)
        atomicMax(marks[pixel], i + 1u);
}
