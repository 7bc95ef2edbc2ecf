#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/tile.glsl"

// Samples whose supports reach into the box around a group's shading points: one search in place of one a pixel. In the order in
// which that finds them, so that sums over them are the same each time. kNearbyThreads for a group of pixels, of which one searches.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { NearbyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Samples;
layout(set = 1, binding = 3) uniform usamplerBuffer Points;
layout(set = 1, binding = 4, scalar) writeonly buffer Nearby { uint nearby[]; };             // kNearbySamples a group
layout(set = 1, binding = 5, scalar) writeonly buffer NearbyCounts { uint nearby_counts[]; }; // kNone: too many
#include "shaders/lib/point.glsl"
#include "shaders/lib/sample.glsl"
#include "shaders/lib/tree.glsl"

shared vec3 lows[kSamplesGroupSize], highs[kSamplesGroupSize];

/// Around a thread's share of the group's points.
void boxPoints(uint group, uint part, uint thread)
{
    vec3 low = vec3(kInfinity), high = vec3(-kInfinity);
    for (uint k = part; k < kRaysGroupSize; k += kNearbyThreads)
    {
        uint pixel = tiledPixel(group * kRaysGroupSize + k, params.width, params.point_count);
        if (group >= params.group_count || pixel >= params.point_count || loadPoint(pixel).slot == kNone)
            continue;
        low = min(low, loadPoint(pixel).position);
        high = max(high, loadPoint(pixel).position);
    }
    lows[thread] = low;
    highs[thread] = high;
}

void main()
{
    uint thread = gl_LocalInvocationID.x, group = gl_GlobalInvocationID.x / kNearbyThreads, part = thread % kNearbyThreads;
    boxPoints(group, part, thread);
    barrier();
    if (part != 0u || group >= params.group_count)
        return;
    vec3 low = lows[thread], high = highs[thread];
    for (uint k = 1u; k < kNearbyThreads; ++k)
    {
        low = min(low, lows[thread + k]);
        high = max(high, highs[thread + k]);
    }
    uint found = 0u, i, end;
    beginRanges(low.x <= high.x ? size.count : 0u);
    for (;;)
    {
        if (nextRange(low, high, 0.0, i, end))
            for (;;)
            {
                SampleTexels s = loadSample(i);
                if (boxDistance2(low, high, s.position, s.position) < s.support2)
                {
                    if (found < kNearbySamples)
                        nearby[group * kNearbySamples + found] = i;
                    ++found;
                }
                if (++i == end)
                    break;
            }
        if (!hasRanges() || found > kNearbySamples)
            break;
    }
    nearby_counts[group] = found > kNearbySamples ? kNone : found;
}
