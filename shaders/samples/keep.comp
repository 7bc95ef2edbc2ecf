#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/samples/samples.h"

// The samples that are kept, with all that was gathered for them. One thread per kept sample.

layout(local_size_x = kSamplesGroupSize) in;

layout(set = 1, binding = 0, scalar) readonly buffer KeptSize { QueueSize kept_size; };
layout(set = 1, binding = 1, scalar) readonly buffer Kept { uint kept[]; }; // old samples
layout(set = 1, binding = 2, scalar) readonly buffer Sums { ClusterSums sums[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 4, scalar) readonly buffer OldSamples { Sample old_samples[]; };
layout(set = 1, binding = 5, scalar) readonly buffer OldTenures { SampleTenure old_tenures[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer Samples { Sample samples[]; };
layout(set = 1, binding = 7, scalar) writeonly buffer Spheres { vec4 spheres[]; };
layout(set = 1, binding = 8, scalar) writeonly buffer Tenures { SampleTenure tenures[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= kept_size.count)
        return;
    uint old = kept[i];
    Sample s = old_samples[old];
    s.pixel = points[sums[old].nearest].pixel; // the nearest to it that is seen now
    samples[i] = s;
    spheres[i] = vec4(s.position, s.support);
    tenures[i] = SampleTenure(old_tenures[old].greatest_eps, old_tenures[old].frames_left - 1u);
}
