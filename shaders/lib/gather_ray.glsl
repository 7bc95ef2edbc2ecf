// Where a sample's gathering rays go. Functions only.
#ifndef LIB_GATHER_RAY_GLSL
#define LIB_GATHER_RAY_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"

/// Cosine-distributed about the sample's normal, and stratified over its rays.
vec3 gatherDirection(vec3 normal, uint new_sample, uint ray, uint seed)
{
    Sampler sampler_ = Sampler(hash(seed, new_sample), ray, 0u);
    return frameAround(normal) * cosineDirection(nextPair(sampler_));
}

#endif
