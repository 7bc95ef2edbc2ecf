#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/emission.glsl"
#include "shaders/photons/photons.h"

// Emits one photon per thread from a light.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { EmitParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Starts { PhotonStart starts[]; };

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.path_count)
        return;
    Sampler sampler_ = Sampler(params.seed, params.first_path + path, 0u);
    Emission emission = emitPhoton(params.aim, sampler_);
    starts[path] = PhotonStart(emission.origin, emission.direction, emission.power / float(params.path_count));
}
