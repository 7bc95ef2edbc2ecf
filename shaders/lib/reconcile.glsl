// What a history is worth where light has changed since it was made. The kernel declares `HistoryParams params` before it
// includes this. Functions only.
#ifndef LIB_RECONCILE_GLSL
#define LIB_RECONCILE_GLSL
#include "shaders/lib/light_pair.glsl"

// Differences of so many standard errors are chance: of the mean over all surroundings, and over the pixels next to this one,
// which find the edges of shadows that move. With less, frames follow their own noise; with more, light lags.
const float kChance = 2.0, kNearChance = 3.0;

struct Followed // what becomes of a term's past: light -> gain x light + more
{
    vec3 gain, more;
    float frames; // factor; less than 0: nothing is known
};

const Followed kUnknown = Followed(vec3(1.0), vec3(0.0), -1.0);

// Noise of a frame, as a part of its light, for as long as there are too few to tell.
const float kLikelyNoise = 0.25;
// What part of its noise a pixel shares with those around it. Irradiance samples and photons serve many pixels at once.
const float kOwnRays = 0.0, kSharedSamples = 0.3, kSharedFar = 0.5;

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
/// past's own frames say. Samples that pixels share show up in every frame, so that less light has less noise; of a pixel's own rays
/// few may find a bright light, and frames in which none does have to be told from darkness.
float singleVariance(Pairs pairs, Memory past, float shared_)
{
    float count = max(pairs.count, 1.0), square_ = dot(pairs.past, pairs.past) / square(count);
    float factor = length(pairs.fresh) / max(length(pairs.past), 1e-30);
    vec3 rest = (pairs.fresh - factor * pairs.past) / count; // of another colour
    float around = dot(pairs.products, vec3(1.0, -2.0 * factor, square(factor))) / count - dot(rest, rest);
    float noise = past.frames < float(kKnownFrames) ? max(past.spread - 1.0, square(kLikelyNoise)) : past.spread - 1.0;
    return max(around, square_ * noise * (shared_ > 0.0 ? min(factor, 1.0) : 1.0));
}

/// @param past frames and spread of the pixel that is compared
Followed followedBy(Memory past, Pairs far, Pairs wide, Pairs near, float shared_)
{
    float frames = past.frames;
    Change change = Change(clamp(vec3(1.0), params.least, params.most), vec3(0.0)); // so much is sure
    float single = singleVariance(wide, past, shared_);
    follow(past, change, far, single, shared_ * kSharedFar, kChance);
    follow(past, change, wide, single, shared_, kChance);
    follow(past, change, near, single, shared_, kNearChance);
    return Followed(change.gain, change.more, past.frames / frames);
}

FollowedTerm packFollowed(Followed f, uint random)
{
    return FollowedTerm(uvec2(packHalf2x16(f.gain.xy), packHalf2x16(vec2(f.gain.z, f.frames))), packMemory(Memory(f.more, 0.0, 1.0), random));
}

Followed unpackFollowed(uvec4 words)
{
    vec2 last = unpackHalf2x16(words.y);
    return Followed(vec3(unpackHalf2x16(words.x), last.x), unpackMemory(words.zw).light, last.y);
}

#endif
