// Reading rays. The kernel declares `usamplerBuffer Rays` before it includes this. Functions only.
#ifndef LIB_RAY_GLSL
#define LIB_RAY_GLSL
#include "shaders/rays/rays.h"

Ray loadRay(uint index)
{
    uvec4 a = texelFetch(Rays, int(2u * index)), b = texelFetch(Rays, int(2u * index + 1u));
    return Ray(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz), b.w);
}

#endif
