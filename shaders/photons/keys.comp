#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/morton.glsl"
#include "shaders/lib/side.glsl"
#include "shaders/photons/photons.h"

// Sort keys of the photon tree: the facing side of a photon's surface, then its position. No node of the tree but its
// topmost few then holds photons of both sides of a sheet, however thin it is, or of a wall and the floor below it. One thread
// per photon.

layout(local_size_x = kRaysGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 3, scalar) writeonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer Order { uint order[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= size.count)
        return;
    Photon photon = photons[slots[i]];
    spheres[i] = vec4(photon.position, 0.0);
    keys[i] = sideOf(unpackNormal(photon.normal)) << 29 | mortonCode(photon.position) >> 1;
    order[i] = i;
}
