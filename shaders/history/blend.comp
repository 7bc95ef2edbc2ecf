#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/history.glsl"
#include "shaders/lib/signal.glsl"

// Makes each term's light the mean of this frame's and of what the same surface showed in the frames before, found where the
// motion says and taken only from pixels that saw that surface (Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering",
// 4.1). Light is stored divided by reflectance, so that textures stay sharp. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4, scalar) writeonly buffer NewHistory { PixelHistory history[]; };
layout(set = 1, binding = 5, scalar) buffer DirectSignals { uvec4 direct_signals[]; };
layout(set = 1, binding = 6, scalar) buffer GlossySignals { uvec4 glossy_signals[]; };
layout(set = 1, binding = 7) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 8, scalar) buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 9, scalar) buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 10, scalar) readonly buffer Displacements { vec3 displacements[]; };
layout(set = 1, binding = 11, scalar) readonly buffer Factors { float factors[]; };

#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/remember.glsl"

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel < params.point_count)
        rememberPixel(pixel, recall(pixel));
}
