#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/random.glsl"

// Rays that feel for the surface around every node of the cut: down its normal, at places chosen by the weight that the
// node has there, over the height in which it has any. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Nodes { CutNode nodes[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Queue { QueueSize queue; }; // set to zero before
layout(set = 1, binding = 3, scalar) writeonly buffer Rays { Ray rays[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    uint ray_count = probeCount(size.count, params.ray_count);
    if (i == 0u)
    {
        uint count = size.count * ray_count;
        queue = queueSize(count);
    }
    if (i >= size.count)
        return;
    CutNode node = nodes[i];
    mat3 frame = frameAround(unpackNormal(node.normal));
    for (uint k = 0u; k < ray_count; ++k)
    {
        Sampler sampler_ = Sampler(hash(params.seed, i), k, 0u);
        vec2 u = nextPair(sampler_);
        float phi = 2.0 * kPi * u.y;
        float r = sqrt(1.0 - sqrt(1.0 - u.x)), height = 0.25 * sqrt(1.0 - r * r); // where the weight vanishes
        vec3 place = vec3(r * cos(phi), r * sin(phi), height) * node.support;
        rays[i * ray_count + k] = Ray(node.center + frame * place, 2.0 * place.z, -frame[2], i * ray_count + k);
    }
}
