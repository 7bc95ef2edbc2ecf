// Signals as numbers. Functions only.
#ifndef LIB_SIGNAL_GLSL
#define LIB_SIGNAL_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/signals/signals.h"

struct Signal
{
    vec3 light;
    vec3 reflectance;
    float lobe;  // width
    float error; // standard, of brightness(); < 0: unknown
};

const float kLeastReflectance = 1e-4; // no light is lost where a lobe's fit says none, and no half is too small
const float kLargestHalf = 65504.0; // infinity would spread

LightSignal packSignal(Signal s)
{
    float sum = s.light.r + s.light.g + s.light.b;
    vec3 parts = clamp(vec3(s.light.rg / max(sum, 1e-30), s.lobe), 0.0, 1.0);
    uvec3 bits = uvec3(parts * vec3(4095.0, 4095.0, 255.0) + 0.5);
    return LightSignal(sum, bits.x | bits.y << 12 | bits.z << 24,
                         uvec2(packHalf2x16(min(s.reflectance.rg, kLargestHalf)),
                               packHalf2x16(min(vec2(s.reflectance.b, s.error), kLargestHalf))));
}

Signal unpackSignal(uvec4 bits)
{
    vec2 chroma = vec2(bits.y & 4095u, bits.y >> 12 & 4095u) / 4095.0, last = unpackHalf2x16(bits.w);
    return Signal(uintBitsToFloat(bits.x) * vec3(chroma, max(0.0, 1.0 - chroma.x - chroma.y)),
                  vec3(unpackHalf2x16(bits.z), last.x), float(bits.y >> 24) / 255.0, last.y);
}

/// Of the light around, the surface's own colours left out.
float brightness(Signal s) { return luminance(s.light) / luminance(s.reflectance); }

#endif
