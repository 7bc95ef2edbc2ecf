#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// Sorts up to kSmallSort pairs in one workgroup.

layout(local_size_x = kPrimitivesGroupSize) in;
layout(constant_id = 0) const uint kKeyWords = 1u;

layout(push_constant, scalar) uniform Push { SmallSortParams params; };
layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1, scalar) buffer Keys { uint keys[]; };
layout(set = 1, binding = 2, scalar) buffer Values { uint values[]; };

const uint kItems = kSmallSortItems;
#include "shaders/primitives/digit.glsl"
#include "shaders/primitives/group_scan.glsl"
#include "shaders/primitives/rank.glsl"

void main()
{
    const uint count = min(size.count, params.max_count);
    if (count < 2u)
        return;
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint at = ownPlace(i);
        tile_keys[i] = uvec2(~0u); // what is missing goes to the end
        tile_values[i] = 0u;
        if (at < count)
        {
            tile_keys[i] = uvec2(keys[at * kKeyWords], kKeyWords > 1u ? keys[at * kKeyWords + 1u] : 0u);
            tile_values[i] = values[at];
        }
    }
    for (uint bit = 0u; bit < params.key_bits; bit += kStepBits)
    {
        rankStep(bit, min(kStepBits, params.key_bits - bit));
        moveToRanks(bit + kStepBits >= params.key_bits);
    }
    [[unroll]] for (uint i = 0u; i < kItems; ++i)
    {
        const uint at = stripedPlace(i);
        if (at >= count)
            continue;
        keys[at * kKeyWords] = tile_keys[i].x;
        if (kKeyWords > 1u)
            keys[at * kKeyWords + 1u] = tile_keys[i].y;
        values[at] = tile_values[i];
    }
}
