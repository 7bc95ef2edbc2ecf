// Where a sample's gathering rays go. Functions only.
#ifndef LIB_GATHER_RAY_GLSL
#define LIB_GATHER_RAY_GLSL
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"

/// A uniform pair for cosineDirection(), stratified over the sample's rays. Where they are a power of two, neighbours go into one
/// wedge of the hemisphere, since threads that trace them do so together.
vec2 gatherPair(uint new_sample, uint ray, uint ray_count, uint seed)
{
    uint bits = uint(findMSB(ray_count));
    if (ray_count == 1u << bits && bits > 0u)
        ray = bitfieldReverse(ray) >> (32u - bits); // the sequence's x is its index, reversed and scrambled
    uvec2 pair = orderedSobolPair(ray, hash(hash(seed, new_sample), 0u));
    return vec2(toUnitFloat(pair.y), toUnitFloat(pair.x));
}

#endif
