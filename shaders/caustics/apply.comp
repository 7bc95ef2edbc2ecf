#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/caustics/caustics.h"
#include "shaders/lib/path.glsl"
#include "shaders/lib/tile.glsl"

// Caustics at every pixel: the light of the photons whose discs its shading point lies in. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { CausticsParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Photons;
layout(set = 1, binding = 3, scalar) readonly buffer Supports { float supports[]; };
layout(set = 1, binding = 4) uniform usamplerBuffer Points;
layout(set = 1, binding = 5, scalar) buffer Radiance { vec3 radiance[]; };
#include "shaders/lib/photon.glsl"
#include "shaders/lib/point.glsl"
#include "shaders/lib/tree.glsl"

struct TwoSided
{
    vec3 front, back; // irradiance, W/m^2
};

/// Each photon's power, spread with the weight (1 - d^2/r^2)^2 over a disc of its own in its surface, over which that weight's
/// integral is pi r^2 / 3 (Silverman 1986, section 5.3, the adaptive kernel method). All power arrives, wherever photons lie.
/// @param n geometric normal at x
TwoSided irradianceAt(vec3 x, vec3 n)
{
    TwoSided sum = TwoSided(vec3(0.0), vec3(0.0));
    uint i, end;
    beginRanges(size.count);
    for (;;)
    {
        if (nextRange(x, 0.0, i, end))
            for (;;)
            {
                Photon photon = loadPhoton(i);
                vec3 normal = unpackNormal(photon.normal);
                float support2 = supports[i], d2 = surfaceDistance2(x - photon.position, normal);
                float facing = dot(n, normal), arriving = dot(n, unpackNormal(photon.direction));
                vec3 light = d2 < support2 ? photon.power * (square(1.0 - d2 / support2) / support2) : vec3(0.0);
                sum.front += facing > 0.1 && arriving < 0.0 ? light : vec3(0.0);
                sum.back += facing < -0.1 && arriving > 0.0 ? light : vec3(0.0);
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    return TwoSided(sum.front * (3.0 * kInvPi), sum.back * (3.0 * kInvPi));
}

void main()
{
    uint pixel = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
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
    TwoSided irradiance = irradianceAt(s.position, s.geometric_normal);
    vec3 light = reflectance * irradiance.front;
    if (translucent)
        light += point.throughput * diffuseTransmittance(v.bsdf, cosine) * irradiance.back;
    radiance[pixel] += kInvPi * light;
}
