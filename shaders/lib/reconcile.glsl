// What a history is worth where light has changed since it was made. The kernel declares `Compared` and what lib/recall.glsl wants.
// Functions only.
#ifndef LIB_RECONCILE_GLSL
#define LIB_RECONCILE_GLSL
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/recall.glsl"

// Differences of so many standard errors are chance: of the mean over all surroundings, and over the pixels next to this one,
// which find the edges of shadows that move. With less, frames follow their own noise; with more, light lags.
const float kChance = 2.0, kNearChance = 3.0;
const int kReach = 3; // pixels to each side: fewer tell less, more blur what has changed
const int kFarStep = 8; // pixels: of those that lie further apart, which show what has changed everywhere

// Places that tell of a pixel's surroundings: all next to it, then every second one up to kReach along either axis, then as many
// far from it. All pixels up to kReach would take three times as long.
const int kNearPlaces = 9, kWidePlaces = 16, kPlaces = kNearPlaces + 2 * kWidePlaces;
ivec2 placeOf(int k)
{
    if (k < kNearPlaces)
        return ivec2(k % 3, k / 3) - 1;
    ivec2 place = ivec2(k % 4, k / 4 % 4) * 2 - kReach;
    return k < kNearPlaces + kWidePlaces ? place : place * kFarStep;
}

bool isNear(ivec2 offset) { return all(lessThanEqual(abs(offset), ivec2(1))); }
// Noise of a frame, as a part of its light, for as long as there are too few to tell.
const float kLikelyNoise = 0.25;
// What part of its noise a pixel shares with those around it. Irradiance samples and photons serve many pixels at once.
const float kOwnRays = 0.0, kSharedSamples = 0.3, kSharedFar = 0.1;

struct Change // light in the history -> what it would be now
{
    vec3 gain, more;
};

/// Moves the past by as much as the pixels' means differ beyond chance: by a factor, or, where there is more than twice the
/// light, by what there is more (after James & Stein 1961, whose weight is squared so that next to nothing stays of what differs
/// clearly). Frames count less then, as means are noisy themselves. @param single variance of a pixel of one frame
void follow(inout Memory past, inout Change change, Pairs pairs, float single, float shared_, float chance)
{
    if (pairs.count < 1.0)
        return;
    vec3 old = pairs.past / pairs.count, before = change.gain * old + change.more;
    vec3 now = clamp(pairs.fresh / pairs.count, params.least * old, params.most * old);
    vec3 d = now - before;
    float part = mix(1.0 / pairs.count, 1.0, shared_) * (1.0 + 1.0 / past.frames); // of `single`, that the means' difference has
    float z2 = dot(d, d) / max(part * single, 1e-30);
    float weight = 1.0 - square(min(1.0, square(chance) / max(z2, 1e-30)));
    vec3 factor = min(now / max(before, vec3(1e-30)), vec3(2.0));
    vec3 gain = mix(vec3(1.0), factor, weight), more = weight * max(now - before * factor, vec3(0.0));
    change = Change(gain * change.gain, gain * change.more + more);
    past.light = gain * past.light + more;
    past.frames /= 1.0 + past.frames * weight * part;
}

/// Variance of a pixel of one frame: what is left between the frame and the past times the factor between their means, or what the
/// past's own frames say, as far as there is as much light as before.
float singleVariance(Pairs pairs, Memory past)
{
    float count = max(pairs.count, 1.0), square_ = dot(pairs.past, pairs.past) / square(count);
    float factor = length(pairs.fresh) / max(length(pairs.past), 1e-30);
    vec3 rest = (pairs.fresh - factor * pairs.past) / count; // of another colour
    float around = dot(pairs.products, vec3(1.0, -2.0 * factor, square(factor))) / count - dot(rest, rest);
    float noise = past.frames < float(kKnownFrames) ? max(past.spread - 1.0, square(kLikelyNoise)) : past.spread - 1.0;
    return max(around, square_ * noise * min(factor, 1.0));
}

void reconcileTerm(inout Memory past, Pairs far, Pairs wide, Pairs near, float shared_)
{
    if (past.frames == 0.0)
        return;
    Change change = Change(clamp(vec3(1.0), params.least, params.most), vec3(0.0)); // so much is sure
    past.light *= change.gain;
    float single = singleVariance(wide, past);
    follow(past, change, far, single, shared_ * kSharedFar, kChance);
    follow(past, change, wide, single, shared_, kChance);
    follow(past, change, near, single, shared_, kNearChance);
}

struct Surroundings // by term
{
    Pairs direct, indirect, glossy, caustics;
};

void addPixel(inout Surroundings s, int pixel)
{
    uvec4 first = texelFetch(Compared, 2 * pixel), second = texelFetch(Compared, 2 * pixel + 1);
    addPair(s.direct, first.xy);
    addPair(s.indirect, first.zw);
    addPair(s.glossy, second.xy);
    addPair(s.caustics, second.zw);
}

/// Compares what the surface shows around the pixel with what it showed.
void reconcile(inout Past past, uint pixel)
{
    ivec2 size = ivec2(params.width, params.point_count / params.width);
    ivec2 here = ivec2(pixel % params.width, pixel / params.width);
    SurfaceGuide guide = loadGuide(pixel);
    vec3 normal = octahedralToUnit(unpackSnorm4x8(guide.normals).xy);
    float footprint = footprintAt(motions[pixel]);
    Surroundings far = Surroundings(kNoPairs, kNoPairs, kNoPairs, kNoPairs), wide = far, near = far;
    for (int k = 0; k < kPlaces; ++k)
    {
        ivec2 offset = placeOf(k), place = here + offset;
        bool twice = k >= kNearPlaces && isNear(offset);
        if (twice || any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size)))
            continue;
        int other = place.y * size.x + place.x;
        SurfaceGuide g = loadGuide(other);
        if (!sameSurface(guide, normal, uvec4(floatBitsToUint(g.position), g.normals), footprint))
            continue;
        if (k >= kNearPlaces + kWidePlaces)
            addPixel(far, other);
        else
            addPixel(wide, other);
        if (k < kNearPlaces)
            addPixel(near, other);
    }
    reconcileTerm(past.direct, far.direct, wide.direct, near.direct, kOwnRays);
    reconcileTerm(past.indirect, far.indirect, wide.indirect, near.indirect, kSharedSamples);
    reconcileTerm(past.glossy, far.glossy, wide.glossy, near.glossy, kOwnRays);
    reconcileTerm(past.caustics, far.caustics, wide.caustics, near.caustics, kSharedSamples);
}

#endif
