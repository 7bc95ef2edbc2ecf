// Reading photons. The kernel declares `usamplerBuffer Photons` before it includes this. Functions only.
#ifndef LIB_PHOTON_GLSL
#define LIB_PHOTON_GLSL
#include "shaders/photons/photons.h"

Photon loadPhoton(uint index)
{
    uvec4 a = texelFetch(Photons, int(2u * index)), b = texelFetch(Photons, int(2u * index + 1u));
    return Photon(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
}

#endif
