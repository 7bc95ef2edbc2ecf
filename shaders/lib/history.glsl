// Unpacking and packing of pixels' histories. Functions only.
#ifndef LIB_HISTORY_GLSL
#define LIB_HISTORY_GLSL
#include "shaders/history/history.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"

struct Memory
{
    vec3 light;    // over reflectance, W/(m^2 sr)
    float frames;  // that it is the mean of
    float spread;  // mean square of single frames' brightness over the square of the mean's, >= 1
};

const Memory kNoMemory = Memory(vec3(0.0), 0.0, 1.0);
const uint kKnownFrames = 4u; // from this many frames on, the error is estimated from the history instead of from neighbours
const float kMantissa = 16383.0;
const float kSpreadSteps = 24.0; // for a factor of two: up to 2^10.6, in steps of 3 %

/// Rounds up or down by chance, so that a mean of many roundings has no bias.
HistoryLight packMemory(Memory m, uint random)
{
    float largest = max(maxComponent(m.light), 1e-30);
    int exponent = clamp(int(ceil(log2(largest))), -120, 120);
    uvec3 draws = uvec3(random & 1023u, random >> 10 & 1023u, random >> 20 & 1023u);
    uvec3 parts = uvec3(clamp(m.light * exp2(-float(exponent)) * kMantissa + (vec3(draws) + 0.5) / 1024.0, vec3(0.0), vec3(kMantissa)));
    uint biased = uint(exponent + 128), frames = uint(clamp(m.frames + 0.5, 0.0, float(kMostHistoryFrames)));
    uint spread = uint(clamp(log2(max(m.spread, 1.0)) * kSpreadSteps + 0.5, 0.0, 255.0));
    return HistoryLight(uvec2(parts.x | parts.y << 14 | biased << 28, parts.z | biased >> 4 << 14 | frames << 18 | spread << 24));
}

Memory unpackMemory(uvec2 words)
{
    uint biased = words.x >> 28 | (words.y >> 14 & 15u) << 4;
    uvec3 parts = uvec3(words.x & 16383u, words.x >> 14 & 16383u, words.y & 16383u);
    return Memory(vec3(parts) * (exp2(float(biased) - 128.0) / kMantissa), float(words.y >> 18 & 63u), exp2(float(words.y >> 24) / kSpreadSteps));
}

#endif
