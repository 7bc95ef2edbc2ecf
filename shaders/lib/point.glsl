// Reading shading points. The kernel declares `usamplerBuffer Points` before it includes this. Functions only.
#ifndef LIB_POINT_GLSL
#define LIB_POINT_GLSL
#include "shaders/primary/primary.h"

ShadingPoint loadPoint(uint index)
{
    int row = int(5u * index);
    uvec4 a = texelFetch(Points, row), b = texelFetch(Points, row + 1);
    vec4 c = uintBitsToFloat(texelFetch(Points, row + 2)), d = uintBitsToFloat(texelFetch(Points, row + 3));
    uvec4 e = texelFetch(Points, row + 4);
    return ShadingPoint(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, c.xyz, vec2(c.w, d.x), d.y, d.z, floatBitsToUint(d.w),
                        uintBitsToFloat(e.xyz), e.w);
}

#endif
