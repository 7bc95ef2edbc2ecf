// Means of pixels' light in this frame and in those before. The kernel declares `buffer NewHistory`, `buffer DirectSignals`,
// `buffer GlossySignals`, `usamplerBuffer DiffusePoints`, `buffer Indirect`, `buffer Caustics` and `HistoryParams params` before it includes
// this. Functions only.
#ifndef LIB_REMEMBER_GLSL
#define LIB_REMEMBER_GLSL
#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/recall.glsl"

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

/// Makes the pixel's light the mean of the past and of this frame, and keeps that for the next.
void rememberPixel(uint pixel, Past past)
{
    float most = float(params.most_frames);
    uint random = hash(params.seed, pixel);
    vec3 reflectance = max(loadDiffusePoint(pixel).reflectance, vec3(kLeastReflectance));
    PixelHistory kept;
    kept.direct = packMemory(rememberSignal(direct_signals[pixel], past.direct, most), random);
    kept.indirect = packMemory(rememberDiffuse(indirect[pixel], reflectance, past.indirect), hash(random));
    if (!kSceneHasGlossy && !kSceneHasCaustics) // else the whole at once: GPUs take a tenth longer over parts
    {
        history[pixel].direct = kept.direct;
        history[pixel].indirect = kept.indirect;
        return;
    }
    kept.glossy = kept.caustics = HistoryLight(uvec2(0u));
    if (kSceneHasGlossy)
    {
        float lobe = unpackSignal(glossy_signals[pixel]).lobe;
        Memory glossy = rememberSignal(glossy_signals[pixel], past.glossy, mix(min(kSharpFrames, most), most, lobe));
        kept.glossy = packMemory(glossy, hash(random + 1u));
    }
    if (kSceneHasCaustics)
        kept.caustics = packMemory(rememberDiffuse(caustics[pixel], reflectance, past.caustics), hash(random + 2u));
    history[pixel] = kept;
}

#endif
