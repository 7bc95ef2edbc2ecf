// Sorts a tile of pairs within a workgroup of kPrimitivesGroupSize threads, kItems pairs each, by a few bits at a time.
// The includer defines kItems and kKeyWords. After Merrill and Grimshaw, "High Performance and Scalable Radix
// Sorting", 2011: every thread counts its own pairs, so no atomics and no subgroup operations are needed.

const uint kStepBits = 4u;
const uint kStepWords = 8u; // counters of 16 digits, two to a word: a tile has less than 2^16 pairs
const uint kTile = kPrimitivesGroupSize * kItems;

uvec2 tile_keys[kItems]; // of pairs thread * kItems + i
uint tile_values[kItems];
uint tile_ranks[kItems];
// Counters [digit % kStepWords][thread], or what the threads exchange.
shared uint s_words[max(kTile, kPrimitivesGroupSize * kStepWords)];

uint ownPlace(uint i)
{
    return gl_LocalInvocationIndex * kItems + i;
}

uint stripedPlace(uint i)
{
    return i * kPrimitivesGroupSize + gl_LocalInvocationIndex;
}

/// tile_ranks becomes the place of each pair in the stable order of this digit. @param bits at most kStepBits
void rankStep(uint first_bit, uint bits)
{
    const uint thread = gl_LocalInvocationIndex;
    barrier();
    [[unroll]] for (uint c = 0u; c < kStepWords; ++c)
        s_words[c * kPrimitivesGroupSize + thread] = 0u;
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint digit = digitOf(tile_keys[i], first_bit, bits);
        const uint word = (digit % kStepWords) * kPrimitivesGroupSize + thread, shift = digit / kStepWords * 16u;
        const uint counter = s_words[word];
        tile_ranks[i] = bitfieldExtract(counter, int(shift), 16);
        s_words[word] = counter + (1u << shift);
    }
    barrier();
    uint sum = 0u, total;
    [[unroll]] for (uint c = 0u; c < kStepWords; ++c)
        sum += s_words[thread * kStepWords + c];
    uint before = groupExclusiveSum(sum, total);
    before += total << 16u; // the upper eight digits come after all of the lower eight
    [[unroll]] for (uint c = 0u; c < kStepWords; ++c)
    {
        const uint counter = s_words[thread * kStepWords + c];
        s_words[thread * kStepWords + c] = before;
        before += counter;
    }
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint digit = digitOf(tile_keys[i], first_bit, bits);
        const uint word = (digit % kStepWords) * kPrimitivesGroupSize + thread, shift = digit / kStepWords * 16u;
        tile_ranks[i] += bitfieldExtract(s_words[word], int(shift), 16);
    }
}

/// Moves every pair to its rank. The threads then hold consecutive pairs, or every kPrimitivesGroupSize-th.
void moveToRanks(bool striped)
{
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
        s_words[tile_ranks[i]] = tile_keys[i].x;
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
        tile_keys[i].x = s_words[striped ? stripedPlace(i) : ownPlace(i)];
    if (kKeyWords > 1u)
    {
        barrier();
        [[unroll]] for (uint i = 0u; i < kItems; ++i)
            s_words[tile_ranks[i]] = tile_keys[i].y;
        barrier();
        [[unroll]] for (uint i = 0u; i < kItems; ++i)
            tile_keys[i].y = s_words[striped ? stripedPlace(i) : ownPlace(i)];
    }
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
        s_words[tile_ranks[i]] = tile_values[i];
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
        tile_values[i] = s_words[striped ? stripedPlace(i) : ownPlace(i)];
}
