// Random numbers: Owen-scrambled Sobol pairs, decorrelated per pixel and per dimension pair by hashing
// (Burley 2020, "Practical Hash-based Owen Scrambling"). Functions only.
#ifndef LIB_RANDOM_GLSL
#define LIB_RANDOM_GLSL

uint hash(uint x) // a low-bias 32-bit integer hash (Wellons' "lowbias32" constants)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

uint hash(uint a, uint b) { return hash(a ^ (hash(b) + 0x9e3779b9u + (a << 6) + (a >> 2))); }

float toUnitFloat(uint bits) { return float(bits >> 8) * (1.0 / 16777216.0); } // [0,1)

/// Permutes bit-reversed values as nested uniform (Owen) scrambling would (Laine & Karras 2011, constants by Burley).
uint permuteReversed(uint x, uint seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

/// Second Sobol dimension: its generator matrix is Pascal's triangle mod 2, a product of five butterfly steps.
uint pascalMod2(uint x)
{
    x ^= (x >> 1) & 0x55555555u;
    x ^= (x >> 2) & 0x33333333u;
    x ^= (x >> 4) & 0x0f0f0f0fu;
    x ^= (x >> 8) & 0x00ff00ffu;
    x ^= (x >> 16) & 0x0000ffffu;
    return x;
}

/// Point `index` of a scrambled (0,2)-sequence in units of 2^-32; `seed` names the pixel and the dimension pair.
uvec2 orderedSobolPair(uint index, uint seed)
{
    uint x = bitfieldReverse(permuteReversed(index, hash(seed ^ 0x68bc21ebu)));
    uint y = bitfieldReverse(permuteReversed(pascalMod2(index), hash(seed ^ 0x02e5be93u)));
    return uvec2(x, y);
}

/// The same with the points shuffled, so that sequences of other seeds go with it by chance.
uvec2 sobolPair(uint index, uint seed)
{
    return orderedSobolPair(bitfieldReverse(permuteReversed(bitfieldReverse(index), hash(seed))), seed);
}

/// A stream of well-distributed pairs for one path: dimension pair after dimension pair.
struct Sampler
{
    uint seed;      // of the pixel
    uint index;     // of the sample
    uint dimension; // next pair
};

uvec2 nextBits(inout Sampler s)
{
    return sobolPair(s.index, hash(s.seed, s.dimension++));
}

vec2 nextPair(inout Sampler s)
{
    uvec2 bits = nextBits(s);
    return vec2(toUnitFloat(bits.x), toUnitFloat(bits.y));
}

/// One item of a stream, each with probability weight / sum of weights (Chao 1982).
struct Reservoir
{
    uint random; // state of a linear congruential generator
    float sum;
    uint chosen; // kNone before the first
};

void offer(inout Reservoir r, float weight, uint item)
{
    r.random = r.random * 747796405u + 2891336453u;
    r.sum += weight;
    if (toUnitFloat(r.random) * r.sum < weight)
        r.chosen = item;
}

/// floor(count * bits / 2^32): a uniform index, exact for any count.
uint toIndex(uint bits, uint count)
{
    uint high, low;
    umulExtended(bits, count, high, low);
    return high;
}

#endif
