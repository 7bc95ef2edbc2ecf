#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/tonemap.glsl"

// Exposure and display transform: radiance sums to 8-bit sRGB pixels. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { TonemapParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Sum { vec3 sum[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Pixels { uint pixels[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.pixel_count)
        return;
    vec3 rgb = toSrgb(displayTransform(params.scale * sum[pixel], params.curve));
    if (params.swap_red_blue != 0u)
        rgb = rgb.bgr;
    pixels[pixel] = packUnorm4x8(vec4(rgb, 1.0));
}
