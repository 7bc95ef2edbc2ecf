#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/voxel.glsl"

// Estimates what each path gives the picture: power times the density of gathering rays where its photons fell. One thread per path.

layout(local_size_x = kGuideGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Offsets { uint offsets[]; }; // by path
layout(set = 1, binding = 3, scalar) readonly buffer Counts { uint counts[]; };   // likewise
layout(set = 1, binding = 4, scalar) readonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 5, scalar) readonly buffer Importance { uint importance[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Values { float values[]; }; // by path
layout(set = 1, binding = 7, scalar) buffer Largest { uint largest; };            // of them, the bits of a float; 0 before

/// Proportional to the area of a surface within a bin.
float binArea(vec3 position, vec3 normal)
{
    vec3 p = position - view_scale.focus, side = sqrt(p * p + square(view_scale.distance)), n = abs(normal);
    return n.x > n.y && n.x > n.z ? side.y * side.z : n.y > n.z ? side.x * side.z : side.x * side.y;
}

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= store.path_count)
        return;
    float value = 0.0;
    for (uint n = offsets[path]; n < offsets[path] + counts[path]; ++n)
    {
        Photon photon = photons[slots[n]];
        vec3 normal = unpackNormal(photon.normal);
        uint rays = min(importance[binOf(photon.position, normal)], kGuideMostImportance);
        value += float(rays) * luminance(photon.power) / binArea(photon.position, normal);
    }
    values[path] = value;
    if (value > 0.0)
        atomicMax(largest, floatBitsToUint(value));
}
