#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/bench/bench.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/scene.glsl"

// From every hit one cosine-distributed ray of unlimited length, as a ray and as a shadow ray: the incoherent load that
// gathering makes. One thread per ray of the queue; rays that missed send none.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { DiffuseParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, scalar) buffer NextQueue { QueueSize next_queue; };
layout(set = 1, binding = 4, scalar) writeonly buffer NextRays { Ray next_rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer ShadowRays { ShadowRay shadow_rays[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= queue.count || hits[i].slot == kNone)
        return;
    uint slot = hits[i].slot;
    vec3 v0 = loadBvhTriangle(slot).v0;
    vec3 normal = normalize(cross(loadBvhTriangle(slot).v1 - v0, loadBvhTriangle(slot).v2 - v0));
    normal = dot(normal, rays[i].direction) > 0.0 ? -normal : normal;
    Sampler s = Sampler(hash(params.seed, rays[i].path), 0u, 0u);
    vec2 u = nextPair(s);
    float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
    vec3 direction = frameAround(normal) * vec3(r * cos(phi), r * sin(phi), sqrt(1.0 - u.x));
    vec3 position = rays[i].origin + hits[i].t * rays[i].direction;
    Ray ray = Ray(offsetOrigin(position, normal), kInfinity, direction, rays[i].path);
    ray.origin += 1e-4 * hits[i].t * normal; // the hit point is not re-computed from the triangle here
    uint next = atomicAdd(next_queue.count, 1u);
    next_rays[next] = ray;
    shadow_rays[next] = ShadowRay(ray, vec3(1.0), 0.0);
}
