#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/samples/quadtree.glsl"

// Splits every node's budget of samples over its four children in proportion to their variation (Algorithm 1). Whole
// numbers, their sum kept exactly; fractions are rounded by systematic sampling, so that over many frames each child gets
// its due; no child gets more than it has points. One thread per node of params.level; one group goes on down to params.last_level.

layout(local_size_x = kSamplesGroupSize) in;
layout(push_constant, scalar) uniform Params { SeedParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { SamplePoint points[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Nodes { QuadNode nodes[]; };
layout(set = 1, binding = 2, scalar) coherent buffer Budgets { uint budgets[]; }; // by node
layout(set = 1, binding = 3, scalar) writeonly buffer Seeds { uint seeds[]; }; // by point, 0 before: 1 where a sample starts

void splitBudget(uint level, uint i)
{
    if (i >= levelCount(level, params.levels))
        return;
    uint node = levelOffset(level, params.levels) + i;
    uint budget = level == params.levels ? min(params.budget, nodes[node].count) : budgets[node];
    if (level == params.levels)
        budgets[node] = budget;
    uint below = level > 1u ? levelOffset(level - 1u, params.levels) : 0u;

    uint counts[4];
    float shares[4];
    float share_sum = 0.0, count_sum = 0.0;
    for (uint c = 0u; c < 4u; ++c)
    {
        if (level > 1u)
            counts[c] = nodes[below + 4u * i + c].count;
        else
            counts[c] = 4u * i + c < points.length() ? uint(points[4u * i + c].pixel != kNone) : 0u;
        shares[c] = level > 1u && params.uniform_ == 0u && counts[c] > 0u ? float(nodes[below + 4u * i + c].variation) : 0.0;
        share_sum += shares[c];
        count_sum += float(counts[c]);
    }
    uint given[4];
    uint left = budget;
    float cumulated = toUnitFloat(hash(params.seed, node));
    for (uint c = 0u; c < 4u; ++c)
    {
        float due = float(budget) * (share_sum > 0.0 ? shares[c] / share_sum : float(counts[c]) / max(count_sum, 1.0));
        float floor_ = floor(cumulated);
        cumulated += due;
        given[c] = min(min(uint(floor(cumulated) - floor_), counts[c]), left);
        left -= given[c];
    }
    for (uint c = 0u; c < 4u && left > 0u; ++c) // what caps and rounding have left over
    {
        uint more = min(left, counts[c] - given[c]);
        given[c] += more;
        left -= more;
    }
    for (uint c = 0u; c < 4u; ++c)
        if (level > 1u)
            budgets[below + 4u * i + c] = given[c];
        else if (given[c] > 0u)
            seeds[4u * i + c] = 1u;
}

void main()
{
    for (uint level = params.level;; --level)
    {
        splitBudget(level, gl_GlobalInvocationID.x);
        if (level == params.last_level)
            break;
        memoryBarrierBuffer();
        barrier();
    }
}
