// Irradiance samples around a shading point. The kernel declares the usamplerBuffer Samples (gpu::SampleTexels) before it
// includes this. Functions only.
#ifndef LIB_SAMPLE_GLSL
#define LIB_SAMPLE_GLSL
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/variation.glsl"

const float kLargestWeight = 100.0;

SampleTexels loadSample(uint index)
{
    int row = int(3u * index);
    vec4 a = uintBitsToFloat(texelFetch(Samples, row)), b = uintBitsToFloat(texelFetch(Samples, row + 1));
    vec4 c = uintBitsToFloat(texelFetch(Samples, row + 2));
    return SampleTexels(a.xyz, a.w, b.xyz, floatBitsToUint(b.w), c.xyz, c.w);
}

/// A sample's weight (Ward et al. 1988), taken smoothly to zero at the rim of its support so that no edge shows where one
/// sample's reach ends; 0 where it is on another surface or in front of x.
float sampleWeight(SampleTexels s, vec3 x, vec3 n)
{
    vec3 d = x - s.position;
    float distance2 = dot(d, d);
    if (distance2 >= s.support2 || dot(n, s.normal) <= 0.01 || dot(d, n + s.normal) * s.inverse_harmonic < -0.01)
        return 0.0;
    float rim = square(max(0.0, 1.0 - surfaceDistance2(d, s.normal) / s.support2));
    return rim * min(kLargestWeight, 1.0 / max(sqrt(distance2) * s.inverse_harmonic + normalVariation(n, s.normal), 1e-6));
}

#endif
