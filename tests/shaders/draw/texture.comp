#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/textures.glsl"
#include "tests/shaders/draw/draw.h"

// What a texture shows at surface coordinates.

layout(local_size_x = kDrawGroupSize) in;
layout(push_constant, scalar) uniform Params { TextureDrawParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Places { TexturePlace places[]; };
layout(set = 1, binding = 1, scalar) writeonly buffer Draws { vec4 draws[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= params.count)
        return;
    vec2 uv = places[i].uv;
    mat2 axes = mat2(places[i].axis_a, places[i].axis_b);
    Footprints footprints = Footprints(axes, axes);
    draws[i] = params.normal == 1u ? vec4(sampleNormal(params.texture, uv, uv, footprints), 0.0)
                                   : sampleTexture(params.texture, uv, uv, footprints);
}
