#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// Moves each pair to where its digit goes: tile by tile, sorted in shared memory first, so that pairs of one digit are
// written side by side.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kKeyWords = 1u;

layout(push_constant, scalar) uniform Push { SortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) readonly buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) readonly buffer Values { uint values[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Offsets { uint offsets[]; }; // [digit][worker], in the digit
layout(set = 1, binding = 4, scalar) readonly buffer Totals { uint totals[]; }; // [digit]
layout(set = 1, binding = 5, scalar) writeonly buffer MovedKeys { uint moved_keys[]; };
layout(set = 1, binding = 6, scalar) writeonly buffer MovedValues { uint moved_values[]; };

shared uint s_next[kMaxDigits];  // where the next pair of the digit goes
shared uint s_start[kMaxDigits]; // of the digit in the sorted tile

const uint kItems = kSortItems;
#include "shaders/primitives/digit.glsl"
#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/rank.glsl"
#include "shaders/primitives/share.glsl"

void loadTile(uint tile, uint end)
{
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint at = tile + ownPlace(i);
        tile_keys[i] = uvec2(~0u); // what is missing goes to the end
        tile_values[i] = 0u;
        if (at < end)
        {
            tile_keys[i] = uvec2(keys[at * kKeyWords], kKeyWords > 1u ? keys[at * kKeyWords + 1u] : 0u);
            tile_values[i] = values[at];
        }
    }
}

/// Leaves the pairs striped, and their digits in s_words.
void sortTile()
{
    for (uint bit = 0u; bit == 0u || bit < params.digit_bits; bit += kStepBits)
    {
        rankStep(params.first_bit + bit, min(kStepBits, params.digit_bits - bit));
        moveToRanks(bit + kStepBits >= params.digit_bits);
    }
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
        s_words[stripedPlace(i)] = digitOf(tile_keys[i], params.first_bit, params.digit_bits);
    barrier();
}

void writeTile(uint pairs)
{
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint place = stripedPlace(i), digit = s_words[place];
        if (place == 0u || s_words[place - 1u] != digit)
            s_start[digit] = place;
    }
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint place = stripedPlace(i), digit = s_words[place];
        if (place >= pairs)
            continue;
        const uint at = s_next[digit] + place - s_start[digit];
        moved_keys[at * kKeyWords] = tile_keys[i].x;
        if (kKeyWords > 1u)
            moved_keys[at * kKeyWords + 1u] = tile_keys[i].y;
        moved_values[at] = tile_values[i];
    }
    barrier();
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint place = stripedPlace(i), digit = s_words[place];
        if (place + 1u == pairs || (place < pairs && s_words[place + 1u] != digit)) // the digit's last
            s_next[digit] += place + 1u - s_start[digit];
    }
}

void main()
{
    const uint thread = gl_LocalInvocationIndex, worker = gl_WorkGroupID.x;
    const uint count = min(size.count, params.max_count);
    const uint share = shareOf(count, params.worker_count, kSortTile);
    const uint begin = worker * share, end = min(begin + share, count);
    if (begin >= count)
        return;
    const bool has_digit = thread < 1u << params.digit_bits;
    uint all;
    const uint start = groupExclusiveSum(has_digit ? totals[thread] : 0u, all);
    s_next[thread] = has_digit ? start + offsets[thread * params.worker_count + worker] : 0u;
    for (uint tile = begin; tile < end; tile += kTile)
    {
        loadTile(tile, end);
        sortTile();
        writeTile(min(end - tile, kTile));
    }
}
