#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/signal.glsl"

// Turns every pixel's averaged signal back into light. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { SignalParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Signals;  // as prepared: they have the pixel's own reflectance
layout(set = 1, binding = 1) uniform usamplerBuffer Filtered;
layout(set = 1, binding = 2, scalar) writeonly buffer Radiance { vec3 radiance[]; };

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    Signal own = unpackSignal(texelFetch(Signals, int(pixel)));
    if (own.lobe == 0.0)
        return;
    Signal around = unpackSignal(texelFetch(Filtered, int(pixel)));
    radiance[pixel] = own.reflectance * around.light / around.reflectance;
}
