#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// Makes each term's light the mean of this frame's and of what the same surface showed in the frames before, found where the
// motion says and taken only from pixels that saw that surface (Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering",
// 4.1). Light is stored divided by reflectance, so that textures stay sharp. Where light has changed since, the past follows what
// its surroundings show (lib/reconcile.glsl). One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4, scalar) writeonly buffer NewHistory { PixelHistory history[]; };
layout(set = 1, binding = 5, scalar) buffer DirectSignals { uvec4 direct_signals[]; };
layout(set = 1, binding = 6, scalar) buffer GlossySignals { uvec4 glossy_signals[]; };
layout(set = 1, binding = 7) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 8, scalar) buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 9, scalar) buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 10) uniform usamplerBuffer Compared; // PixelPairs, where light has changed
layout(constant_id = 0) const uint kLightChanged = 0u;
layout(set = 1, binding = 11, scalar) readonly buffer Displacements { vec3 displacements[]; };

#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/recall.glsl"
#include "shaders/lib/reconcile.glsl"

// Reflections move with the eye: the sharper the lobe, the fewer past frames are used. A lobe of width 1 moves with the surface,
// like diffuse light.
const float kSharpFrames = 4.0;

/// The mean of the past, of at most `most` frames, and of `light`.
Memory remember(Memory past, vec3 light, float most)
{
    if (any(isnan(light)) || any(isinf(light)))
        return past;
    float frames = min(past.frames, most), part = 1.0 / (frames + 1.0);
    vec3 mean = mix(past.light, light, part);
    float square_ = mix(past.spread * square(luminance(past.light)), square(luminance(light)), part);
    return Memory(mean, frames + 1.0, max(square_ / max(square(luminance(mean)), 1e-30), 1.0));
}

/// Standard error of the mean's brightness; < 0 if there are too few frames.
float errorOf(Memory m)
{
    return m.frames < float(kKnownFrames) ? -1.0 : luminance(m.light) * sqrt((m.spread - 1.0) / m.frames);
}

Memory rememberSignal(inout uvec4 bits, Memory past, float most)
{
    Signal s = unpackSignal(bits);
    if (s.lobe == 0.0)
        return kNoMemory;
    Memory m = remember(past, lightOver(s.light, s.reflectance, past), most);
    s.light = m.light * s.reflectance;
    s.error = errorOf(m);
    LightSignal packed = packSignal(s);
    bits = uvec4(floatBitsToUint(packed.sum), packed.chroma, packed.reflectance);
    return m;
}

Memory rememberDiffuse(inout vec3 light, vec3 reflectance, Memory past)
{
    Memory m = remember(past, lightOver(light, reflectance, past), float(params.most_frames));
    light = m.light * reflectance;
    return m;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    Past past = recall(pixel);
    if (kLightChanged != 0u)
        reconcile(past, pixel);
    float most = float(params.most_frames);
    uint random = hash(params.seed, pixel);
    vec3 reflectance = max(loadDiffusePoint(pixel).reflectance, vec3(kLeastReflectance));
    float lobe = unpackSignal(glossy_signals[pixel]).lobe;
    history[pixel] = PixelHistory(
        packMemory(rememberSignal(direct_signals[pixel], past.direct, most), random),
        packMemory(rememberDiffuse(indirect[pixel], reflectance, past.indirect), hash(random)),
        packMemory(rememberSignal(glossy_signals[pixel], past.glossy, mix(min(kSharpFrames, most), most, lobe)), hash(random + 1u)),
        packMemory(rememberDiffuse(caustics[pixel], reflectance, past.caustics), hash(random + 2u)));
}
