#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// Marks the old samples that are kept: those that own a point and may stay longer, but no more than leaves those points
// that nobody has claimed their share of the budget. Where that would be too many, the ones that have the least time left
// go. One group.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { ClusterParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 2, scalar) readonly buffer OldTenures { SampleTenure old_tenures[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Quota { SampleQuota quota; };
layout(set = 1, binding = 4, scalar) writeonly buffer Flags { uint flags[]; };

shared uint sample_counts[kMostSampleFrames]; // by the frames they have left

uint framesLeft(uint sample_) { return sums[sample_].count > 0u ? min(old_tenures[sample_].frames_left, kMostSampleFrames - 1u) : 0u; }

void main()
{
    uint t = gl_LocalInvocationID.x;
    for (uint i = t; i < kMostSampleFrames; i += kSamplesGroupSize)
        sample_counts[i] = 0u;
    barrier();
    for (uint i = t; i < size.count; i += kSamplesGroupSize)
        atomicAdd(sample_counts[framesLeft(i)], 1u);
    barrier();
    float unclaimed = float(quota.point_count - quota.claimed_count) / float(max(quota.point_count, 1u));
    uint most = params.budget - min(params.budget, uint(ceil(float(params.budget) * unclaimed)));
    uint least_frames = kMostSampleFrames, kept = 0u;
    while (least_frames > 1u && kept + sample_counts[least_frames - 1u] <= most)
        kept += sample_counts[--least_frames];
    for (uint i = t; i < size.count; i += kSamplesGroupSize)
        flags[i] = uint(framesLeft(i) >= least_frames);
}
