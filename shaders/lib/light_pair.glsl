// Pairs of light now and before, packed, and their sums. Functions only.
#ifndef LIB_LIGHT_PAIR_GLSL
#define LIB_LIGHT_PAIR_GLSL
#include "shaders/lib/history.glsl"

struct Pairs // sums over pixels of one surface
{
    vec3 fresh, past; // light over reflectance, in this frame and in the mean of those before
    vec3 products;    // fresh * fresh, fresh * past, past * past, over the channels
    float count;
};

const Pairs kNoPairs = Pairs(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);

uint packShared(vec3 light)
{
    float largest = maxComponent(light);
    int exponent = clamp(int(ceil(log2(max(largest, 1e-30) * (255.5 / 255.0)))), -120, 120);
    uvec3 parts = uvec3(clamp(light * exp2(-float(exponent)) * 255.0 + 0.5, vec3(0.0), vec3(255.0)));
    return parts.x | parts.y << 8 | parts.z << 16 | uint(exponent + 128) << 24;
}

/// 0 of 0, which packShared() never gives: its exponent is not 0.
vec3 unpackShared(uint word)
{
    float unit = word == 0u ? 0.0 : uintBitsToFloat(((word >> 24) - 1u) << 23); // 2^(exponent - 128)
    return vec3(word & 255u, word >> 8 & 255u, word >> 16 & 255u) * (unit * (1.0 / 255.0));
}

LightPair packPair(vec3 fresh, Memory past)
{
    bool known = past.frames > 0.0 && !any(isnan(fresh)) && !any(isinf(fresh));
    return LightPair(known ? uvec2(packShared(fresh), packShared(past.light)) : uvec2(0u));
}

void addPair(inout Pairs sum, uvec2 words)
{
    vec3 fresh = unpackShared(words.x), past = unpackShared(words.y);
    sum.fresh += fresh;
    sum.past += past;
    sum.products += vec3(dot(fresh, fresh), dot(fresh, past), dot(past, past));
    sum.count += words.x == 0u ? 0.0 : 1.0;
}

#endif
