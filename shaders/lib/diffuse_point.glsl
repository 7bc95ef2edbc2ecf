// Reading diffuse points. The kernel declares `usamplerBuffer DiffusePoints` before it includes this. Functions only.
#ifndef LIB_DIFFUSE_POINT_GLSL
#define LIB_DIFFUSE_POINT_GLSL
#include "shaders/primary/primary.h"

DiffusePoint loadDiffusePoint(uint index)
{
    vec4 a = uintBitsToFloat(texelFetch(DiffusePoints, int(2u * index)));
    vec4 b = uintBitsToFloat(texelFetch(DiffusePoints, int(2u * index + 1u)));
    return DiffusePoint(a.xyz, vec2(a.w, b.x), b.yzw);
}

#endif
