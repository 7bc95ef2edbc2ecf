// Random numbers that are independent from draw to draw, as Pearson's statistic supposes. Functions only.
#ifndef TESTS_SHADERS_INDEPENDENT_GLSL
#define TESTS_SHADERS_INDEPENDENT_GLSL
#include "shaders/lib/random.glsl"

/// Every draw is the first point of a sequence of its own, whose scrambling hashes it to anywhere in the square.
Sampler independentSampler(uint seed, uint draw) { return Sampler(hash(hash(seed), draw), 0u, 0u); }

#endif
