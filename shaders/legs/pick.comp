#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/legs/legs.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"

// Samples segments (legs) of photons' paths in proportion to their power, each from a range of paths of its own. One thread per
// leg.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { LegParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Photons { Photon photons[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Slots { uint slots[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Offsets { uint offsets[]; }; // by path
layout(set = 1, binding = 3, scalar) readonly buffer Counts { uint counts[]; };   // likewise
layout(set = 1, binding = 4, scalar) readonly buffer Store { PhotonStore store; };
layout(set = 1, binding = 5, scalar) writeonly buffer Legs { Leg legs[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= kLegCount)
        return;
    uint first = i * store.path_count / kLegCount, end = (i + 1u) * store.path_count / kLegCount;
    uint stride = max((end - first + kLegPaths - 1u) / kLegPaths, 1u);
    uint random = hash(params.seed, i);
    Reservoir reservoir = Reservoir(random, 0.0, kNone);
    for (uint path = first + toIndex(hash(random), stride); path < end; path += stride)
        for (uint n = offsets[path] + 1u; n < offsets[path] + counts[path]; ++n) // a path's first photon comes from its light
            offer(reservoir, luminance(photons[slots[n]].power), n);
    legs[i] = Leg(vec3(0.0), 0u, vec3(0.0), 0.0);
    if (reservoir.chosen == kNone)
        return;
    Photon left = photons[slots[reservoir.chosen - 1u]], arrived = photons[slots[reservoir.chosen]];
    vec3 way = length(arrived.position - left.position) * unpackNormal(arrived.direction); // not straight where mirrors are between
    legs[i] = Leg(arrived.position - way, arrived.normal, arrived.position, reservoir.sum);
}
