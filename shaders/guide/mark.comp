#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/voxel.glsl"

// Marks the places where gathering rays ended. One thread per kGuideMarkStride rays of the queue.

layout(local_size_x = kGuideGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1, scalar) readonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Hits { Hit hits[]; };
layout(set = 1, binding = 3, scalar) buffer Wanted { uint wanted[]; }; // by voxel, 0 before

void main()
{
    uint i = gl_GlobalInvocationID.x * kGuideMarkStride;
    if (i >= queue.count || hits[i].slot == kNone)
        return;
    uint voxel = voxelAt(rays[i].origin + hits[i].t * rays[i].direction);
    if (wanted[voxel] == 0u)
        atomicOr(wanted[voxel], 1u);
}
