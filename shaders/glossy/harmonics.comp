#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/glossy/glossy.h"
#include "shaders/lib/harmonics.glsl"
#include "shaders/lib/path.glsl"
#include "shaders/lib/tile.glsl"

// Reflection of rough lobes at a shading point, from the spherical harmonics of the irradiance samples whose support contains
// it, with the weights of interpolation. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { GlossyParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Size { QueueSize size; };
layout(set = 1, binding = 1) uniform usamplerBuffer TreeNodes;
layout(set = 1, binding = 2) uniform usamplerBuffer Samples;
layout(set = 1, binding = 3) uniform usamplerBuffer Points;
layout(set = 1, binding = 4, scalar) buffer Radiance { vec3 radiance[]; };
layout(set = 1, binding = 6) uniform usamplerBuffer Harmonics; // SampleHarmonics, a texel a channel
layout(set = 1, binding = 7) uniform usamplerBuffer Lobes; // GlossyLobe, a texel each
layout(set = 1, binding = 8, scalar) writeonly buffer Shares { float shares[]; }; // of glossy light that needs no ray
layout(set = 1, binding = 9, scalar) readonly buffer Nearby { uint nearby[]; };
layout(set = 1, binding = 10, scalar) readonly buffer NearbyCounts { uint nearby_counts[]; };
#include "shaders/lib/nearby.glsl"
#include "shaders/lib/point.glsl"
#include "shaders/lib/sample.glsl"
#include "shaders/lib/tree.glsl"

vec4 loadLobe(uint index) { return uintBitsToFloat(texelFetch(Lobes, int(index))); }

/// The table's entry between its neighbours.
GlossyLobe lobeAt(float roughness, float cosine)
{
    vec2 at = vec2(clamp((roughness - kHarmonicsFrom) / (1.0 - kHarmonicsFrom), 0.0, 1.0) * float(kLobeRoughnesses - 1u),
                   clamp(cosine, 0.0, 1.0) * float(kLobeCosines - 1u));
    uvec2 cell = min(uvec2(at), uvec2(kLobeRoughnesses, kLobeCosines) - 2u);
    at -= vec2(cell);
    uint first = cell.x * kLobeCosines + cell.y;
    vec4 lobe = (1.0 - at.x) * (1.0 - at.y) * loadLobe(first) + at.x * (1.0 - at.y) * loadLobe(first + kLobeCosines) +
                (1.0 - at.x) * at.y * loadLobe(first + 1u) + at.x * at.y * loadLobe(first + kLobeCosines + 1u);
    return GlossyLobe(lobe.x, lobe.y, lobe.z, lobe.w);
}

/// Light that a sample sends into the lobe, times its evenLight.
vec3 incidentLight(vec3 irradiance, uint slot, Reflection r)
{
    int texel = int(3u * slot);
    vec3 light = vec3(channelLight(r, texelFetch(Harmonics, texel)), channelLight(r, texelFetch(Harmonics, texel + 1)),
                      channelLight(r, texelFetch(Harmonics, texel + 2)));
    return irradiance * max(light, vec3(0.0));
}

vec4 weightedLight(SampleTexels s, vec3 x, vec3 n, Reflection r)
{
    float weight = sampleWeight(s, x, n);
    return weight > 0.0 ? weight * vec4(incidentLight(s.irradiance, s.slot, r), evenLight(r, s.normal)) : vec4(0.0);
}

vec4 searchedLight(vec3 x, vec3 n, Reflection r)
{
    vec4 sum = vec4(0.0);
    uint i, end;
    beginRanges(size.count);
    for (;;)
    {
        if (nextRange(x, 0.0, i, end))
            for (;;)
            {
                sum += weightedLight(loadSample(i), x, n, r);
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    return sum;
}

/// pi times the mean radiance over the lobe. @param found of loadNearby(), @return false where no sample reaches
bool interpolatedLight(uint found, vec3 x, vec3 n, Reflection r, out vec3 light)
{
    vec4 sum = vec4(0.0);
    if (found == kNone)
        sum = searchedLight(x, n, r);
    else
        for (uint k = 0u; k < found; ++k)
            sum += weightedLight(nearby_samples[k], x, n, r);
    light = sum.rgb / max(sum.w, 1e-20);
    return sum.w > 0.0;
}

void main()
{
    uint found = loadNearby();
    uint pixel = tiledPixel(gl_GlobalInvocationID.x, params.width, params.point_count);
    if (pixel >= params.point_count)
        return;
    ShadingPoint point = loadPoint(pixel);
    if (point.slot == kNone)
        return;
    shares[pixel] = 0.0;
    PathVertex v = vertexAt(point);
    Surface s = v.surface;
    Bsdf b = v.bsdf;
    float share = harmonicShare(b);
    if (share == 0.0)
        return;
    float cosine = max(0.0, -dot(s.normal, point.direction));
    GlossyLobe lobe = lobeAt(sqrt(b.alpha), cosine);
    vec3 light;
    if (!interpolatedLight(found, s.position, s.smooth_normal, reflectionBy(lobe, s.normal, -point.direction), light))
        return;
    vec3 reflectance = lobe.scale * mix(b.f0, b.base_color, b.metallic) + lobe.bias * mix(b.f90, 1.0, b.metallic);
    shares[pixel] = share;
    radiance[pixel] += share * kInvPi * point.throughput * reflectance * light;
}
