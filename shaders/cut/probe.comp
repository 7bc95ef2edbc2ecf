#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cut_node.glsl"
#include "shaders/lib/random.glsl"

// Coverage probe rays of every node of the cut: from a point above its centre to points on its disc, chosen by the node's weight
// there. They end where the disc lies on a visible surface. Others go to the disc's rim and detect whether anything stands on
// it. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Nodes { CutNode nodes[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Queue { QueueSize queue; }; // set to zero before
layout(set = 1, binding = 4, scalar) writeonly buffer Rays { Ray rays[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    ProbeParams probes = probesFor(size.count, params);
    uint all = probes.ray_count + probes.rim_count;
    if (i == 0u)
    {
        uint count = size.count * all;
        queue = queueSize(count);
    }
    if (i >= size.count || all == 0u)
        return;
    CutNode node = nodes[i];
    mat3 frame = frameAround(cutNormal(node));
    float height = eyeHeight(node);
    for (uint k = 0u; k < probes.ray_count; ++k)
    {
        Sampler sampler_ = Sampler(hash(params.seed, i), k, 0u);
        vec2 u = nextPair(sampler_);
        float phi = 2.0 * kPi * u.y, r = sqrt(1.0 - sqrt(1.0 - u.x));
        vec3 to_place = vec3(r * cos(phi) * node.support, r * sin(phi) * node.support, -height);
        float below = 0.25 * sqrt(1.0 - r * r) * node.support; // how far off its plane the node has any weight
        float distance = length(to_place);
        rays[i * all + k] = Ray(node.center + height * frame[2], distance * (1.0 + below / max(height, 1e-20)),
                                      frame * to_place / distance, i * all + k);
    }
    float turn = toUnitFloat(hash(params.seed, ~i));
    for (uint k = 0u; k < probes.rim_count; ++k) // just above the rim: a bump of the floor must not count as a wall
    {
        float phi = 2.0 * kPi * (float(k) + turn) / float(probes.rim_count);
        vec3 to_rim = vec3(cos(phi) * node.support, sin(phi) * node.support, -0.95 * height);
        float distance = length(to_rim);
        rays[i * all + probes.ray_count + k] =
            Ray(node.center + height * frame[2], distance, frame * to_rim / distance, i * all + probes.ray_count + k);
    }
}
