#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/photons/photons.h"

// Lists appended photons in the order of their paths, which does not depend on that of threads. One thread per photon.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer InOrder { QueueSize in_order; };
layout(set = 1, binding = 1, scalar) readonly buffer Tags { PhotonTag tags[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Offsets { uint offsets[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Slots { uint slots[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < in_order.count)
        slots[offsets[tags[i].path] + tags[i].number] = i;
}
