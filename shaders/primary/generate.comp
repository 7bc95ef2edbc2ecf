#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/primary/primary.h"

// Makes the camera rays, each through a random point of its pixel (box filter), from the near plane to the far one. One
// thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { CameraParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Rays { Ray rays[]; };

void main()
{
    uint path = gl_GlobalInvocationID.x;
    uint pixel_count = params.width * params.height;
    if (path >= pixel_count * params.sample_count)
        return;
    uint sample_ = path / pixel_count, pixel = path - sample_ * pixel_count;
    uint row = pixel / params.width, column = pixel - row * params.width;
    Sampler s = Sampler(hash(params.seed, pixel), params.first_sample + sample_, 0u);
    vec2 position = vec2(column, row) + nextPair(s);
    vec2 image = vec2(2.0, -2.0) * position / vec2(params.width, params.height) + vec2(-1.0, 1.0);
    vec3 offset = image.x * params.right + image.y * params.up;
    Ray ray = Ray(params.position, kInfinity, params.forward, path);
    float per_depth = 1.0; // metres along the ray for one along forward
    if (params.orthographic != 0u)
        ray.origin += offset;
    else
    {
        per_depth = length(params.forward + offset);
        ray.direction = normalize(params.forward + offset);
    }
    ray.origin += params.near_plane * per_depth * ray.direction;
    if (params.far_plane > 0.0)
        ray.t_max = (params.far_plane - params.near_plane) * per_depth;
    rays[path] = ray;
}
