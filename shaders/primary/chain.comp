#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/tile.glsl"
#include "shaders/lib/view.glsl"

// What the camera rays do where they first meet something: most end at their pixel's shading point, or in the sky. One thread per
// pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { ChainParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Hits;
layout(set = 1, binding = 1, scalar) writeonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer DiffusePoints { DiffusePoint diffuse_points[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 4, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 5, scalar) writeonly buffer NextRays { Ray next_rays[]; };
#include "shaders/lib/chain.glsl"
#include "shaders/lib/hit.glsl"

void send(Ray ray) { next_rays[atomicAdd(next_queue.count, 1u)] = ray; }

void main()
{
    uint thread = gl_GlobalInvocationID.x;
    if (thread >= pixelCount())
        return;
    uint pixel = tiledPixel(thread, params.camera.width, pixelCount());
    Ray ray = pixelRay(params.camera, pixel, 0u);
    ChainVertex c;
    // The near plane is where the ray starts.
    c.point = beginPoint(ray.direction, 0u, vec3(1.0), params.width + params.spread * length(ray.origin - params.camera.position));
    c.second = beginPoint(ray.direction, 0u, vec3(0.0), params.width);
    c.diffuse = kNoDiffusePoint;
    c.light = vec3(0.0);
    bool splits = params.splits != 0u;
    chainVertex(c, ray, loadHit(thread), 0u, splits);
    points[pixel] = c.point;
    diffuse_points[pixel] = c.diffuse;
    radiance[pixel] = c.light;
    if (c.goes_on)
        send(c.next);
    if (!hasFeature(kFeatureDeltaLobes) || !splits)
        return;
    uint second = pixel + pixelCount();
    points[second] = c.second;
    diffuse_points[second] = kNoDiffusePoint;
    radiance[second] = vec3(0.0);
    if (c.splits)
        send(c.second_next);
}
