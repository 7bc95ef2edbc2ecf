#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/history.glsl"
#include "shaders/lib/signal.glsl"

// Makes each term's light the mean of this frame's and of what the same surface showed in the frames before, found where the
// motion says and taken only from pixels that saw that surface (Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering",
// 4.1). Light is stored divided by reflectance, so that textures stay sharp. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Guides { SurfaceGuide guides[]; };
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4, scalar) writeonly buffer NewHistory { PixelHistory history[]; };
layout(set = 1, binding = 5, scalar) buffer DirectSignals { uvec4 direct_signals[]; };
layout(set = 1, binding = 6, scalar) buffer GlossySignals { uvec4 glossy_signals[]; };
layout(set = 1, binding = 7, scalar) readonly buffer DiffusePoints { DiffusePoint diffuse_points[]; };
layout(set = 1, binding = 8, scalar) buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 9, scalar) buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 10, scalar) readonly buffer Displacements { vec3 displacements[]; };

const float kOffPlane = 2.0;   // pixels, off the surface's plane, at which another pixel's surface is another one
const float kFarAlong = 32.0;  // pixels, along it: what a pixel covers of a surface seen at 2 degrees
const float kSameFacing = 0.9; // cosine between smooth normals of one surface
const float kLeastTap = 0.02;  // weights that sum to less are rounding
const uint kKnownFrames = 4u;  // from this many frames on, the error is estimated from the history instead of from neighbours

// Reflections move with the eye: the sharper the lobe, the fewer past frames are used. A lobe of width 1 moves with the surface,
// like diffuse light.
const float kSharpFrames = 4.0;

struct Past
{
    Memory direct, indirect, glossy, caustics;
};

struct Taps // weighted sums over the pixels around
{
    Memory sum;
    float weights;
};

const Taps kNoTaps = Taps(Memory(vec3(0.0), 0.0, 0.0), 0.0);

void addTap(inout Taps taps, uvec2 words, float weight)
{
    Memory m = unpackMemory(words);
    if (m.frames == 0.0) // a pixel of that surface which has no such light: nothing is known, which is not black
        return;
    taps.sum.light += weight * m.light;
    taps.sum.frames += weight * m.frames;
    taps.sum.spread += weight * m.spread;
    taps.weights += weight;
}

Memory meanOf(Taps taps)
{
    Memory m = taps.sum;
    return taps.weights < kLeastTap ? kNoMemory : Memory(m.light / taps.weights, m.frames / taps.weights, m.spread / taps.weights);
}

bool sameSurface(SurfaceGuide now, vec3 normal, uvec4 old, float pixel)
{
    vec3 d = uintBitsToFloat(old.xyz) - now.position;
    float rounding = 1e-5 * maxComponent(abs(now.position)); // of positions far from the origin
    return abs(dot(d, normal)) <= kOffPlane * pixel + rounding && dot(d, d) <= square(kFarAlong * pixel + rounding) &&
           dot(octahedralToUnit(unpackSnorm4x8(old.w).xy), normal) >= kSameFacing;
}

/// What those of the four pixels around where it was remember that saw the surface.
Past recall(uint pixel)
{
    Taps direct = kNoTaps, indirect_ = kNoTaps, glossy = kNoTaps, caustics_ = kNoTaps;
    Motion motion = motions[pixel];
    if (params.has_previous == 0u || motion.from.x == kNoMotion || !(motion.distance < kInfinity))
        return Past(kNoMemory, kNoMemory, kNoMemory, kNoMemory);
    ivec2 size = ivec2(params.width, params.point_count / params.width);
    vec2 at = vec2(pixel % params.width, pixel / params.width) + motion.from;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    SurfaceGuide guide = guides[pixel];
    if (params.moves != 0u)
        guide.position -= displacements[pixel]; // where it was
    vec3 normal = octahedralToUnit(unpackSnorm4x8(guide.normals).xy);
    float footprint = params.pixel_side + params.pixel_angle * motion.distance;
    for (int k = 0; k < 4; ++k)
    {
        ivec2 step_ = ivec2(k & 1, k >> 1), place = corner + step_;
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))
            continue;
        int old = place.y * size.x + place.x;
        vec2 near = mix(1.0 - part, part, equal(step_, ivec2(1)));
        float weight = near.x * near.y;
        if (!(weight > 0.0) || !sameSurface(guide, normal, texelFetch(OldGuides, old), footprint))
            continue;
        uvec4 first = texelFetch(OldHistory, 2 * old), second = texelFetch(OldHistory, 2 * old + 1);
        addTap(direct, first.xy, weight);
        addTap(indirect_, first.zw, weight);
        addTap(glossy, second.xy, weight);
        addTap(caustics_, second.zw, weight);
    }
    return Past(meanOf(direct), meanOf(indirect_), meanOf(glossy), meanOf(caustics_));
}

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

/// Light over reflectance. Of a channel in which the pixel reflects nothing, as dispersion leaves one a frame, it tells nothing:
/// the past does, else another channel.
vec3 lightOver(vec3 light, vec3 reflectance, Memory past)
{
    vec3 ratio = light / reflectance;
    bvec3 unknown = lessThanEqual(reflectance, vec3(1.01 * kLeastReflectance)); // a half may have rounded it up
    if (all(unknown)) // light by another lobe, of which this mean is as good as any
        return ratio;
    return mix(ratio, past.frames > 0.0 ? past.light : vec3(maxComponent(ratio)), unknown);
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
    float most = float(params.most_frames);
    uint random = hash(params.seed, pixel);
    vec3 reflectance = max(diffuse_points[pixel].reflectance, vec3(kLeastReflectance));
    float lobe = unpackSignal(glossy_signals[pixel]).lobe;
    history[pixel] = PixelHistory(
        packMemory(rememberSignal(direct_signals[pixel], past.direct, most), random),
        packMemory(rememberDiffuse(indirect[pixel], reflectance, past.indirect), hash(random)),
        packMemory(rememberSignal(glossy_signals[pixel], past.glossy, mix(min(kSharpFrames, most), most, lobe)), hash(random + 1u)),
        packMemory(rememberDiffuse(caustics[pixel], reflectance, past.caustics), hash(random + 2u)));
}
