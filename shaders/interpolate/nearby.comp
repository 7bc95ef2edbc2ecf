#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/tile.glsl"

// Samples whose supports reach into the box around a group's shading points: one search in place of one a pixel. In the order in
// which that finds them, so that sums over them are the same each time. One thread per group of pixels.

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

void main()
{
    uint group = gl_GlobalInvocationID.x;
    if (group >= params.group_count)
        return;
    vec3 low = vec3(kInfinity), high = vec3(-kInfinity);
    for (uint k = 0u; k < kRaysGroupSize; ++k)
    {
        uint pixel = tiledPixel(group * kRaysGroupSize + k, params.width, params.point_count);
        if (pixel >= params.point_count || loadPoint(pixel).slot == kNone)
            continue;
        low = min(low, loadPoint(pixel).position);
        high = max(high, loadPoint(pixel).position);
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
