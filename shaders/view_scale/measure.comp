#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/math.glsl"
#include "shaders/primary/primary.h"
#include "shaders/view_scale/measure.h"
#include "shaders/view_scale/view_scale.h"

// The geometric mean of the shading points' distances from the camera: a few far hills in a window do not move it. Of parallel rays
// the mean depth, which is of any sign. One group, so that the order of the sum is fixed.

layout(local_size_x = kMeasureGroupSize) in;
layout(push_constant, scalar) uniform Params { MeasureViewParams params; };

layout(set = 1, binding = 0) uniform usamplerBuffer Points;
layout(set = 1, binding = 1, scalar) buffer Scale { ViewScale scale; }; // keeps its distance where there is nothing in view

const int kPointTexels = 5; // of a ShadingPoint

shared vec2 sums[kMeasureGroupSize]; // of logarithms or depths, and points

void main()
{
    uint t = gl_LocalInvocationID.x;
    uint wanted = min(params.point_count, kMeasureGroupSize * kMeasuredPoints);
    vec2 sum = vec2(0.0);
    for (uint i = t; i < wanted; i += kMeasureGroupSize)
    {
        uint index = uint(float(i) * (float(params.point_count) / float(wanted)));
        uvec4 point = texelFetch(Points, kPointTexels * int(min(index, params.point_count - 1u))); // position and slot
        vec3 to_point = uintBitsToFloat(point.xyz) - params.eye;
        float along = params.orthographic != 0u ? dot(to_point, params.forward) : log(length(to_point));
        if (point.w != kNone && !isinf(along))
            sum += vec2(along, 1.0);
    }
    sums[t] = sum;
    for (uint half_ = kMeasureGroupSize / 2u; half_ > 0u; half_ /= 2u)
    {
        barrier();
        if (t < half_)
            sums[t] += sums[t + half_];
    }
    if (t != 0u)
        return;
    bool seen = sums[0].y > 0.0;
    float mean = seen ? sums[0].x / sums[0].y : 0.0, away = 0.0; // from the eye to the focus
    if (params.orthographic != 0u)
    {
        scale.distance = params.size;
        away = seen ? mean - params.size : 0.0;
    }
    else if (seen)
    {
        scale.distance = exp(mean) * params.size;
        away = exp(mean) - scale.distance;
    }
    scale.focus = params.eye + away * params.forward;
}
