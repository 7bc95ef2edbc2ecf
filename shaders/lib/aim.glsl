// Aims gathering rays where light comes from, estimated from segments (legs) of photons' paths that arrived nearby, so that no
// rays are spent on what is bright but occluded (Jensen 1995, "Importance Driven Path Tracing using the Photon Map"; from where each
// came is known here, and is seen from the sample under another angle). One group per sample: all its threads call each function.
#ifndef LIB_AIM_GLSL
#define LIB_AIM_GLSL
#include "shaders/legs/legs.h"
#include "shaders/lib/math.glsl"

shared uint aim_counts[kAimCells];        // light from each cell; kAimWhole together, or 0
shared float aim_rows[kAimCells];         // probability of a cell and those before it in its column
shared float aim_columns[kAimColumns];    // of a column and those before it
shared float aim_squares[kAimColumns];    // of each: sum of the squares of what its cells count
shared vec2 aim_sums[kRaysGroupSize];     // of the legs' weights and of their squares

/// Light that comes to a place x, of normal n, the way a leg came to its end: less certain the farther that is from x, and none on
/// the other side of a sheet.
float legWeight(Leg leg, vec3 x, vec3 n)
{
    const float kMostRatio = 4.0;
    vec3 d = leg.from - x, e = leg.to - x, way = leg.from - leg.to, m = unpackNormal(leg.normal);
    float distance2 = dot(d, d), way2 = dot(way, way), height = dot(d, n), height_there = dot(way, m);
    if (leg.power <= 0.0 || height <= 0.0 || height_there <= 0.0)
        return 0.0;
    float here = height * inversesqrt(distance2) / distance2, there = height_there * inversesqrt(way2) / way2;
    return leg.power * min(here / there, kMostRatio) * square((0.5 + 0.5 * dot(n, m)) / (1.0 + dot(e, e) / distance2));
}

/// @param local unit, z along the normal
uint aimCell(vec3 local)
{
    float turn = fract(atan(local.y, local.x) / (2.0 * kPi));
    uint column = min(uint(turn * float(kAimColumns)), kAimColumns - 1u);
    return column * kAimRows + min(uint((1.0 - square(local.z)) * float(kAimRows)), kAimRows - 1u);
}

/// Probability that a ray is aimed by legs: 0 where their distribution over cells may be due to chance. For n equal legs in c equally
/// likely cells the squares of the cells' fractions sum to 1 / c + 1 / n on average; only the excess is evidence.
float aimShare()
{
    float squares = 0.0;
    for (uint c = 0u; c < kAimColumns; ++c)
        squares += aim_squares[c];
    float uneven = squares - 1.0 / float(kAimCells), noise = aim_sums[0].y / square(max(aim_sums[0].x, 1e-30));
    return squares > 0.0 && uneven > noise ? kAimMost * (1.0 - noise / uneven) : 0.0;
}

/// Makes the distribution of what aim_counts holds, and of the cosine's rays. @param thread of the group
void distributeAim(uint thread)
{
    if (thread < kAimColumns)
    {
        aim_squares[thread] = 0.0;
        for (uint c = thread * kAimRows; c < (thread + 1u) * kAimRows; ++c)
            aim_squares[thread] += square(float(aim_counts[c]) / float(kAimWhole));
    }
    barrier();
    float share = aimShare(), running = 0.0;
    for (uint c = thread * kAimRows; thread < kAimColumns && c < (thread + 1u) * kAimRows; ++c)
    {
        running += (1.0 - share) / float(kAimCells) + share * float(aim_counts[c]) / float(kAimWhole);
        aim_rows[c] = running;
    }
    barrier();
    if (thread < kAimColumns)
    {
        running = 0.0;
        for (uint c = 0u; c <= thread; ++c)
            running += aim_rows[(c + 1u) * kAimRows - 1u];
        aim_columns[thread] = running;
    }
    barrier();
}

/// u within [low, high) as a place in part number `part` of `parts`.
float placeWithin(float u, float low, float high, uint part, uint parts)
{
    return (float(part) + clamp((u - low) / (high - low), 0.0, 0.9999999)) / float(parts);
}

/// Moves a uniform pair, for cosineDirection(), to where light comes from. @param weight density of the pair over that after it
vec2 aimPair(vec2 pair, out float weight)
{
    float all = aim_columns[kAimColumns - 1u], u = pair.y * all;
    uint column = 0u;
    while (column + 1u < kAimColumns && u >= aim_columns[column])
        ++column;
    float y = placeWithin(u, column > 0u ? aim_columns[column - 1u] : 0.0, aim_columns[column], column, kAimColumns);
    uint first = column * kAimRows, row = 0u;
    u = pair.x * aim_rows[first + kAimRows - 1u];
    while (row + 1u < kAimRows && u >= aim_rows[first + row])
        ++row;
    float low = row > 0u ? aim_rows[first + row - 1u] : 0.0, high = aim_rows[first + row];
    weight = all / ((high - low) * float(kAimCells));
    return vec2(placeWithin(u, low, high, row, kAimRows), y);
}

#endif
