#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/emission.glsl"
#include "shaders/photons/photons.h"

// Sends one photon per thread into the scene.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { EmitParams params; };

layout(set = 1, binding = 0, scalar) buffer Queue { QueueSize queue; };
layout(set = 1, binding = 1, scalar) writeonly buffer Rays { Ray rays[]; };
layout(set = 1, binding = 2, scalar) writeonly buffer States { PhotonState states[]; };

void main()
{
    uint path = gl_GlobalInvocationID.x;
    if (path >= params.path_count)
        return;
    Sampler sampler_ = Sampler(params.seed, params.first_path + path, 0u);
    Emission emission = emitPhoton(params.aim, sampler_);
    if (emission.power == vec3(0.0))
        return;
    states[path] = PhotonState(emission.power / float(params.path_count), kNone, 0u, 0u);
    rays[atomicAdd(queue.count, 1u)] = Ray(emission.origin, kInfinity, emission.direction, path);
}
