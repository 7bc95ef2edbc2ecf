#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/caustics/caustics.h"
#include "shaders/lib/path.glsl"

// Caustics at every pixel: density estimation among the caustic photons around its shading point. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { CausticsParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3) uniform usamplerBuffer Points;
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
#include "shaders/lib/point.glsl"
#include "shaders/lib/density.glsl"

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count || loadPoint(pixel).slot == kNone)
        return;
    ShadingPoint point = loadPoint(pixel);
    PathVertex v = vertexAt(point);
    Surface s = v.surface;
    float cosine = max(0.0, v.wo.z);
    vec3 reflectance = point.throughput * diffuseReflectance(v.bsdf, cosine);
    bool translucent = isTranslucent(v.bsdf);
    if (reflectance == vec3(0.0) && !translucent)
        return;
    float radius = params.radius * viewDistance(s.position);
    DensityEstimate estimate = estimateIrradiance(s.position, s.geometric_normal, size.count, params.photon_count,
                                                  square(radius), square(radius) / 16.0);
    vec3 light = reflectance * estimate.irradiance;
    if (translucent)
    {
        estimate = estimateIrradiance(s.position, -s.geometric_normal, size.count, params.photon_count, square(radius), square(radius) / 16.0);
        light += point.throughput * diffuseTransmittance(v.bsdf, cosine) * estimate.irradiance;
    }
    radiance[pixel] += kInvPi * light;
}
