// What pixels remember of their surfaces. The kernel declares `buffer Motions`, `buffer Displacements`, `buffer Factors`, `Guides`,
// `OldGuides`, `OldHistory` and `HistoryParams params` before it includes this. Functions only.
#ifndef LIB_RECALL_GLSL
#define LIB_RECALL_GLSL
#include "shaders/lib/light_terms.glsl"
#include "shaders/lib/same_surface.glsl"
#include "shaders/lib/signal.glsl"

const float kLeastTap = 0.02; // weights that sum to less are rounding

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

/// What those of the four pixels around where it was remember that saw the surface.
Past recall(uint pixel)
{
    Taps direct = kNoTaps, indirect_ = kNoTaps, glossy = kNoTaps, caustics_ = kNoTaps;
    Motion motion = motions[pixel];
    if (params.has_previous == 0u || motion.from.x == kNoMotion || !(motion.distance < kInfinity))
        return Past(kNoMemory, kNoMemory, kNoMemory, kNoMemory);
    ivec2 size = ivec2(params.width, quotient(params.point_count, params.width));
    uint row = quotient(pixel, params.width);
    vec2 at = vec2(pixel - row * params.width, row) + motion.from;
    ivec2 corner = ivec2(floor(at));
    vec2 part = at - vec2(corner);
    SurfaceGuide guide = loadGuide(pixel);
    if (params.moves != 0u)
        guide.position -= displacements[pixel]; // where it was
    vec3 normal = octahedralToUnit(unpackSnorm4x8(guide.normals).xy);
    float footprint = footprintAt(motion);
    [[unroll]] for (int k = 0; k < 4; ++k)
    {
        ivec2 step_ = ivec2(k & 1, k >> 1), place = corner + step_;
        if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))
            continue;
        int old = place.y * size.x + place.x;
        vec2 near = mix(1.0 - part, part, equal(step_, ivec2(1)));
        float weight = near.x * near.y;
        if (!(weight > 0.0) || !sameSurface(guide, normal, texelFetch(OldGuides, old), footprint))
            continue;
        uvec4 first = texelFetch(OldHistory, 2 * old);
        addTap(direct, first.xy, weight);
        addTap(indirect_, first.zw, weight);
        if (!kSceneHasGlossy && !kSceneHasCaustics)
            continue;
        uvec4 second = texelFetch(OldHistory, 2 * old + 1);
        if (kSceneHasGlossy)
            addTap(glossy, second.xy, weight);
        if (kSceneHasCaustics)
            addTap(caustics_, second.zw, weight);
    }
    Past past = Past(meanOf(direct), meanOf(indirect_), meanOf(glossy), meanOf(caustics_));
    if (params.highlights != 0u)
    {
        // Which lamps the pixel itself sees is not known: in the shadow of one, its highlight would be a ghost. The more it has
        // changed, the sooner frames of now correct it.
        float factor = factors[pixel];
        past.direct.light *= factor;
        past.direct.frames *= min(factor, 1.0 / factor);
    }
    return past;
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

#endif
