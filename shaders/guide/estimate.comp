#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/voxel.glsl"

// Estimates the importance of each cell: the sum over its paths of the importance where their photons fell. One thread per path.

layout(local_size_x = kGuideGroupSize) in;
layout(push_constant, scalar) uniform Params { EstimateParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) readonly buffer Distribution { GuideDistribution distribution; };
layout(set = 1, binding = 2, scalar) readonly buffer Cells { uint cells[]; }; // by path; kNone: nothing left
layout(set = 1, binding = 3, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Offsets { uint offsets[]; }; // by path
layout(set = 1, binding = 6, scalar) readonly buffer Counts { uint counts[]; };   // likewise
layout(set = 1, binding = 7, scalar) readonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 8, scalar) readonly buffer Importance { uint importance[]; };
layout(set = 1, binding = 9, scalar) buffer Estimates { GuideEstimate estimates[]; };
#include "shaders/lib/guide.glsl"

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= store.path_count || cells[path] == kNone)
        return;
    uint count = 0u;
    for (uint n = offsets[path]; n < offsets[path] + counts[path]; ++n)
    {
        uint slot = slots[n];
        count += min(importance[binOf(photons[slot].position, unpackNormal(photons[slot].normal))], kGuideMostImportance);
    }
    if (count == 0u)
        return;
    uint cell = cells[path];
    float weight = cellShare(cell) / cellProbability(cell);
    atomicAdd(estimates[cell].now, max(1u, uint(float(count) * weight * params.scale + 0.5)));
}
