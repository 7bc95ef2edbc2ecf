#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/interpolate/interpolate.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/tile.glsl"
#include "shaders/lib/variation.glsl"
#include "shaders/lib/view_scale.glsl"

// Indirect diffuse light of every pixel from the samples whose support holds its shading point. One thread per run of
// kRun neighbouring pixels: they share one search, which finds what any of them needs, and what it loads. Runs of one pixel look at
// what was found for their group.

layout(constant_id = 3) const uint kRun = 1u;

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { InterpolateParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Samples;
layout(set = 1, binding = 3) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 5, scalar) buffer Statistics { InterpolateStatistics statistics; };
layout(set = 1, binding = 6, scalar) readonly buffer Nearby { uint nearby[]; };
layout(set = 1, binding = 7, scalar) readonly buffer NearbyCounts { uint nearby_counts[]; };
#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/nearby.glsl"
#include "shaders/lib/sample.glsl"
#include "shaders/lib/tree.glsl"

const float kFarthest = 1e6; // of Eq. 2: farther than any sample

// The pixels of a run. Loops over them are unrolled: arrays that stay in registers.
vec3 x[kRun], n[kRun], reflectance[kRun];
vec4 sum[kRun]; // of weighted irradiance and of weights

/// Loads the run that starts at `pixel`; between low and high lies what of it is diffuse. @return whether anything is
bool loadRun(uint pixel, out vec3 low, out vec3 high)
{
    low = vec3(kInfinity);
    high = vec3(-kInfinity);
    [[unroll]] for (uint k = 0u; k < kRun; ++k)
    {
        DiffusePoint point = loadDiffusePoint(min(pixel + k, params.point_count - 1u));
        x[k] = point.position;
        n[k] = octahedralToUnit(point.normal);
        reflectance[k] = pixel + k < params.point_count ? point.reflectance : vec3(0.0);
        sum[k] = vec4(0.0);
        if (reflectance[k] != vec3(0.0))
        {
            low = min(low, x[k]);
            high = max(high, x[k]);
        }
    }
    return low.x <= high.x;
}

/// Gives the pixels that no sample accepts the irradiance of the sample of least variation.
void takeNearest(vec3 low, vec3 high)
{
    float best[kRun];
    float alpha = params.alpha / view_scale.distance, farthest = kFarthest;
    uint missing = 0u;
    [[unroll]] for (uint k = 0u; k < kRun; ++k)
    {
        bool is_missing = sum[k].w == 0.0 && reflectance[k] != vec3(0.0);
        best[k] = is_missing ? farthest : -1.0;
        missing += uint(is_missing);
    }
    if (missing == 0u)
        return;
    uint i, end;
    beginRanges(size.count);
    for (;;)
    {
        if (nextRange(low, high, square(farthest / alpha), i, end))
            for (;;)
            {
                SampleTexels s = loadSample(i);
                farthest = 0.0;
                [[unroll]] for (uint k = 0u; k < kRun; ++k)
                {
                    float eps = geometricVariation(alpha, x[k], n[k], s.position, s.normal);
                    if (eps < best[k])
                    {
                        best[k] = eps;
                        sum[k] = vec4(s.irradiance, 1.0);
                    }
                    farthest = max(farthest, best[k]);
                }
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    uint unlit = 0u;
    [[unroll]] for (uint k = 0u; k < kRun; ++k)
        unlit += uint(sum[k].w == 0.0 && reflectance[k] != vec3(0.0));
    atomicAdd(statistics.fallbacks, missing);
    atomicAdd(statistics.unlit, unlit);
}

void addSample(SampleTexels s)
{
    [[unroll]] for (uint k = 0u; k < kRun; ++k)
        sum[k] += sampleWeight(s, x[k], n[k]) * vec4(s.irradiance, 1.0);
}

/// Adds all samples whose support reaches between low and high.
void search(vec3 low, vec3 high)
{
    uint i, end;
    beginRanges(size.count);
    for (;;)
    {
        if (nextRange(low, high, 0.0, i, end))
            for (;;)
            {
                addSample(loadSample(i));
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
}

void main()
{
    uint found = kNone, pixel = gl_GlobalInvocationID.x * kRun;
    if (kRun == 1u)
    {
        found = loadNearby();
        pixel = tiledPixel(pixel, params.width, params.point_count);
    }
    vec3 low, high;
    if (pixel >= params.point_count || !loadRun(pixel, low, high))
        return;
    if (found == kNone)
        search(low, high);
    else
        for (uint k = 0u; k < found; ++k)
            addSample(nearby_samples[k]);
    takeNearest(low, high);
    [[unroll]] for (uint k = 0u; k < kRun; ++k)
        if (sum[k].w > 0.0 && reflectance[k] != vec3(0.0))
        {
            vec3 shown = params.white != 0u ? vec3(notEqual(reflectance[k], vec3(0.0))) : reflectance[k];
            radiance[pixel + k] += shown * kInvPi * (sum[k].rgb / sum[k].w);
        }
}
