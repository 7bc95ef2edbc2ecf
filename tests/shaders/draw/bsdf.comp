#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/path.glsl"
#include "tests/shaders/draw/draw.h"
#include "tests/shaders/draw/independent.glsl"

// Directions that the BSDF chooses, normals that are visible from one, or the BSDF's value towards even directions.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { BsdfDrawParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Draws { BsdfDraw draws[]; };

SurfaceMaterial materialOfParams()
{
    SurfaceMaterial m;
    m.base_color = vec3(params.base_color);
    m.metallic = params.metallic;
    m.roughness = params.roughness;
    m.transmission = params.transmission;
    m.specular = params.specular;
    m.specular_color = vec3(1.0);
    m.ior = params.ior;
    m.emission = vec3(0.0);
    m.flags = params.flags;
    m.clearcoat = params.clearcoat;
    m.clearcoat_roughness = params.clearcoat_roughness;
    m.sheen_color = vec3(params.sheen);
    m.sheen_roughness = params.sheen_roughness;
    m.anisotropy = params.anisotropy;
    m.grain = vec2(1.0, 0.0);
    m.iridescence = params.iridescence;
    m.iridescence_ior = params.film_ior;
    m.iridescence_thickness = params.film_thickness;
    m.dispersion = params.dispersion;
    m.diffuse_transmission = params.diffuse_transmission;
    m.diffuse_transmission_color = vec3(params.base_color);
    return m;
}

/// @param random in [0, 1): picks the channel of a material that disperses light
Bsdf bsdfOfParams(float random)
{
    PathVertex v;
    v.material = materialOfParams();
    v.surface.front = params.front == 1u;
    v.bsdf = bsdfAt(v.material, v.surface.front, params.clearcoat_normal);
    disperse(v, vec3(1.0), random);
    return v.bsdf;
}

/// Seen from the other side where wi lies there: the material is then taken for thin.
BsdfDraw valueTowards(Bsdf b, vec3 wi)
{
    BsdfValue f = evaluateBsdf(b, params.wo, wi);
    float side = wi.z < 0.0 ? -1.0 : 1.0;
    BsdfValue back = evaluateBsdf(b, vec3(wi.xy, side * wi.z), vec3(params.wo.xy, side * params.wo.z));
    return BsdfDraw(wi, f.pdf, f.diffuse + f.specular, back.diffuse.r + back.specular.r);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Sampler s = independentSampler(params.seed, i);
    vec2 u = nextPair(s);
    vec2 choices = nextPair(s);
    Bsdf b = bsdfOfParams(choices.y);
    if (params.what == kDrawVisibleNormals)
    {
        vec3 h = sampleVisibleNormal(params.wo, alphas(b), u);
        draws[i] = BsdfDraw(h, visibleNormalPdf(params.wo, h, alphas(b)), vec3(1.0), 0.0);
        return;
    }
    if (params.what == kDrawValues)
    {
        float z = 1.0 - 2.0 * u.x, r = sqrt(max(0.0, 1.0 - z * z)), phi = 2.0 * kPi * u.y;
        draws[i] = valueTowards(b, vec3(r * cos(phi), r * sin(phi), z));
        return;
    }
    BsdfSample drawn = sampleBsdf(b, params.wo, choices.x, u);
    draws[i] = BsdfDraw(drawn.wi, drawn.pdf, drawn.weight, 0.0);
}
