// Reading what rays hit. The kernel declares `usamplerBuffer Hits` before it includes this. Functions only.
#ifndef LIB_HIT_GLSL
#define LIB_HIT_GLSL
#include "shaders/rays/rays.h"

Hit loadHit(uint index)
{
    uvec4 a = texelFetch(Hits, int(index));
    return Hit(uintBitsToFloat(a.x), a.y, uintBitsToFloat(a.zw));
}

#endif
