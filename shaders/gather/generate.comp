#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"

// Cosine-distributed, stratified rays from every new sample. One thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 2, scalar) buffer Queue { QueueSize queue; };
layout(set = 1, binding = 3, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 4, scalar) readonly buffer KeptSize { QueueSize kept_size; }; // the first samples, which have all they need

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint count = (size.count - kept_size.count) * params.ray_count;
    if (i == 0u)
        queue = QueueSize(uvec3((count + kRaysGroupSize - 1u) / kRaysGroupSize, 1u, 1u), count);
    if (i >= count)
        return;
    uint new_sample = i / params.ray_count, sample_ = kept_size.count + new_sample;
    Sampler sampler_ = Sampler(hash(params.seed, new_sample), i % params.ray_count, 0u);
    vec2 u = nextPair(sampler_);
    vec3 normal = unpackNormal(samples[sample_].normal);
    float r = sqrt(u.x), phi = 2.0 * kPi * u.y;
    vec3 direction = frameAround(normal) * vec3(r * cos(phi), r * sin(phi), sqrt(max(0.0, 1.0 - u.x)));
    rays[i] = Ray(offsetOrigin(samples[sample_].position, normal), kInfinity, direction, i);
}
