#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// Where light has changed since the last frame: what each pixel shows beside what its surface showed before, for its
// surroundings to compare. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4) uniform usamplerBuffer DirectSignals;
layout(set = 1, binding = 5) uniform usamplerBuffer GlossySignals;
layout(set = 1, binding = 6) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 7, scalar) readonly buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 8, scalar) readonly buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 9, scalar) writeonly buffer Compared { PixelPairs pairs[]; };
layout(set = 1, binding = 10, scalar) readonly buffer Displacements { vec3 displacements[]; };

#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/recall.glsl"

LightPair pairOf(uvec4 bits, Memory past)
{
    Signal s = unpackSignal(bits);
    return s.lobe == 0.0 ? LightPair(uvec2(0u)) : packPair(lightOver(s.light, s.reflectance, past), past);
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    Past past = recall(pixel);
    vec3 reflectance = max(loadDiffusePoint(pixel).reflectance, vec3(kLeastReflectance));
    pairs[pixel] = PixelPairs(pairOf(texelFetch(DirectSignals, int(pixel)), past.direct),
                              packPair(lightOver(indirect[pixel], reflectance, past.indirect), past.indirect),
                              pairOf(texelFetch(GlossySignals, int(pixel)), past.glossy),
                              packPair(lightOver(caustics[pixel], reflectance, past.caustics), past.caustics));
}
