#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/cut_node.glsl"

// The nodes of the cut in the order of their tree, and how many threads probe them. One thread per node.

layout(local_size_x = kCutGroupSize) in;
layout(push_constant, scalar) uniform Params { ProbeParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Ids { uint ids[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Order { uint order[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Finals { CutNode finals[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Directions { uint directions[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Nodes { CutNode nodes[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer NodeDirections { uint node_directions[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer ProbeSize { QueueSize probe_size; }; // 0 before

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    if (i == 0u)
    {
        ProbeParams probes = probesFor(size.count, params);
        probe_size = queueSize(size.count * kProbeThreads);
        probe_size.count = size.count * (probes.ray_count + probes.rim_count);
    }
    nodes[i] = finals[ids[order[i]]];
    node_directions[i] = directions[order[i]];
}
