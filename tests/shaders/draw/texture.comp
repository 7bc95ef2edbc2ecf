#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/textures.glsl"
#include "tests/shaders/draw/draw.h"

// What a texture shows at surface coordinates.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { TextureDrawParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Places { vec3 places[]; }; // u, v, footprint
layout(set = 1, binding = 1, scalar) writeonly buffer Draws { vec4 draws[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    vec2 uv = places[i].xy, footprints = vec2(places[i].z);
    draws[i] = params.normal == 1u ? vec4(sampleNormal(params.texture, uv, uv, footprints), 0.0)
                                   : sampleTexture(params.texture, uv, uv, footprints);
}
