#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/antialias/antialias.h"

// The picture of a static view: the mean of its frames, with the picture of the moving camera fading out. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { StandParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Sum { vec3 sum[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Before { vec3 before[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer Shown { vec3 shown[]; };
layout(set = 1, binding = 3, scalar) buffer Counts { float counts[]; }; // frames in the mean of `shown`

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    vec3 mean = params.scale * sum[pixel];
    shown[pixel] = params.before > 0.0 ? mix(mean, before[pixel], params.before) : mean;
    counts[pixel] = min(counts[pixel] + 1.0, params.most_frames);
}
