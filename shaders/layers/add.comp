#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/layers/layers.h"
#include "shaders/lib/path.glsl"
#include "shaders/pose/pose.h"

// Adds what a frame made of each term, of both points of a pixel, and what its first point is like. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { LayersParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Points { ShadingPoint points[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Emission { vec3 emission[]; };
layout(set = 1, binding = 2, scalar) readonly buffer SharpDirect { vec3 sharp_direct[]; };
layout(set = 1, binding = 3, scalar) readonly buffer Direct { vec3 direct[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 5, scalar) readonly buffer Glossy { vec3 glossy[]; };
layout(set = 1, binding = 6, scalar) readonly buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 7, scalar) buffer Layers { LayerSums layers[]; };
layout(set = 1, binding = 8, scalar) readonly buffer Views { FrameViews views; };
layout(set = 1, binding = 9, scalar) readonly buffer LastCorners { TriangleCorners last_corners[]; };

#include "shaders/lib/motion.glsl"

bool has(uint term) { return (params.terms & term) != 0u; }

void addLight(inout LayerSums sums, uint point)
{
    if (has(kLightEmission))
        sums.emission += emission[point];
    if (has(kLightSharpDirect))
        sums.direct += sharp_direct[point];
    if (has(kLightDirect))
        sums.direct += direct[point];
    if (has(kLightIndirect))
        sums.indirect += indirect[point];
    if (has(kLightGlossy))
        sums.glossy += glossy[point];
    if (has(kLightCaustics))
        sums.caustics += caustics[point];
}

float depthOf(ShadingPoint point)
{
    if (params.spread == 0.0)
        return dot(point.position - params.eye, params.forward);
    return point.depth == 0u ? distance(point.position, params.eye) : point.width / params.spread;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.pixel_count)
        return;
    vec3 none = vec3(0.0);
    LayerSums sums = LayerSums(none, none, none, none, none, none, none, kSkyDepth, vec2(0.0));
    if (params.adds != 0u)
        sums = layers[pixel];
    sums.depth = kSkyDepth;
    sums.motion = vec2(0.0); // nothing has moved while frames are added
    addLight(sums, pixel);
    if (params.point_count > params.pixel_count)
        addLight(sums, params.pixel_count + pixel);
    ShadingPoint point = points[pixel];
    if (params.has_last != 0u)
    {
        Motion motion = motionOf(pixel, point, displacementOf(point), params.spread, true);
        sums.motion = motion.from.x == kNoMotion ? vec2(0.0) : motion.from;
    }
    if (point.slot != kNone)
    {
        PathVertex v = vertexAt(point);
        float cosine = max(0.0, v.wo.z);
        vec3 reflectance = diffuseReflectance(v.bsdf, cosine) + (hasGlossyLobe(v.bsdf) ? specularReflectance(v.bsdf, cosine) : none);
        sums.albedo += point.throughput * reflectance;
        sums.normal += v.surface.normal;
        sums.depth = depthOf(point);
    }
    layers[pixel] = sums;
}
