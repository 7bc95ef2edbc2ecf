#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/gather/gather.h"
#include "shaders/lib/gather_ray.glsl"

// Cosine-distributed, stratified rays from every new sample. One thread per ray.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GatherParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 2, scalar) buffer Queue { QueueSize queue; };
layout(set = 1, binding = 3, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer States { GatherState states[]; };
layout(set = 1, binding = 4, scalar) readonly buffer KeptSize { QueueSize kept_size; }; // the first samples, which have all they need

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint count = (size.count - kept_size.count) * params.ray_count;
    if (i == 0u)
        queue = queueSize(count);
    if (i >= count)
        return;
    uint new_sample = i / params.ray_count, sample_ = kept_size.count + new_sample;
    vec3 normal = unpackNormal(samples[sample_].normal);
    vec3 direction = gatherDirection(normal, new_sample, i - new_sample * params.ray_count, params.ray_count, params.seed);
    rays[i] = Ray(offsetOrigin(samples[sample_].position, normal), kInfinity, direction, i);
    states[i] = GatherState(vec3(1.0), kNone, 0u);
}
