#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/photons/photons.h"

// The positions of the photons that were stored, side by side. One thread per photon.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Spheres { vec4 spheres[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < size.count)
        spheres[i] = vec4(photons[slots[i]].position, 0.0);
}
