#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/emission.glsl"
#include "shaders/guide/guide.h"

// Emits one photon per thread, like photons/emit.comp but with the learned distribution: more photons of less power each where
// importance is high.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { EmitParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Groups { GuideGroups groups; };
layout(set = 1, binding = 1, scalar) readonly buffer Distribution { GuideDistribution distribution; };
layout(set = 1, binding = 2, scalar) readonly buffer OtherLights { float other_lights[]; }; // by light: cumulative fraction of power
layout(set = 1, binding = 3, scalar) writeonly buffer Starts { PhotonStart starts[]; };
layout(set = 1, binding = 4, scalar) writeonly buffer Cells { uint cells[]; };
#include "shaders/lib/guide.glsl"

uint otherLight(float u)
{
    uint low = 0u, high = scene.light_count - 1u;
    while (low < high)
    {
        uint middle = (low + high) / 2u;
        if (u < other_lights[middle])
            high = middle;
        else
            low = middle + 1u;
    }
    return low;
}

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.path_count)
        return;
    Sampler sampler_ = Sampler(params.seed, params.first_path + path, 0u);
    float pick = nextPair(sampler_).x;
    nextPair(sampler_);
    vec2 u = nextPair(sampler_), v = nextPair(sampler_);
    uint cell = pickCell(pick), group = cell / kGuideCells, place = cell % kGuideCells;
    bool beam = group < kGuideInfiniteLights;
    if (beam)
        u = (vec2(place % kGuideSide, place / kGuideSide) + u) / float(kGuideSide);
    uint light = beam ? groups.infinite_lights[group]
                      : otherLight((float(place) + pick) / float(kGuideCells) * groups.shares[group]);
    Emission emission;
    if (beam)
        emission = emitInfinite(loadLight(light), u, v, sampler_);
    else
        emission = emitFrom(loadLight(light), 0.0, false, 0u, u, v, sampler_);
    bool leaves = emission.power != vec3(0.0);
    cells[path] = leaves ? cell : kNone;
    float weight = leaves ? cellShare(cell) / cellProbability(cell) : 0.0;
    starts[path] = PhotonStart(emission.origin, emission.direction, emission.power * (weight / float(params.path_count)));
}
