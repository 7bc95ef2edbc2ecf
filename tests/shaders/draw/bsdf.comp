#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/bsdf.glsl"
#include "tests/shaders/draw/draw.h"
#include "tests/shaders/draw/independent.glsl"

// Directions that the BSDF chooses, or the normals that are visible from one.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { BsdfDrawParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Draws { DirectionDraw draws[]; };

Bsdf bsdfOfParams()
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
    return bsdfAt(m, params.front == 1u);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    Sampler s = independentSampler(params.seed, i);
    vec2 u = nextPair(s);
    float choice = nextPair(s).x;
    Bsdf b = bsdfOfParams();
    if (params.visible_normals == 1u)
    {
        vec3 h = sampleVisibleNormal(params.wo, b.alpha, u);
        draws[i] = DirectionDraw(h, visibleNormalPdf(params.wo, h, b.alpha));
        return;
    }
    BsdfSample drawn = sampleBsdf(b, params.wo, choice, u);
    draws[i] = DirectionDraw(drawn.wi, drawn.pdf);
}
