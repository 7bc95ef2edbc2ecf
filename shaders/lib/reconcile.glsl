// What a history is worth where light has changed since it was made. The kernel, whose groups work on a tile each, declares
// `Compared`, `readonly buffer Tiles`, and what lib/history_tile.glsl and lib/recall.glsl want. Functions and shared memory.
#ifndef LIB_RECONCILE_GLSL
#define LIB_RECONCILE_GLSL
#include "shaders/lib/history_tile.glsl"
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/recall.glsl"

// Differences of so many standard errors are chance: of the mean over all surroundings, and over the pixels next to this one,
// which find the edges of shadows that move. With less, frames follow their own noise; with more, light lags.
const float kChance = 2.0, kNearChance = 3.0;
const int kReach = 3; // pixels to each side: fewer tell less, more blur what has changed
const int kTilesBeside = 3, kTileStep = 2; // along either axis, and how far apart: tiles that show what has changed everywhere

// Places that tell of a pixel's surroundings: all next to it, then every second one up to kReach along either axis. All pixels up
// to kReach would take twice as long.
const int kNearPlaces = 9, kPlaces = kNearPlaces + 16;
ivec2 placeOf(int k)
{
    return k < kNearPlaces ? ivec2(k % 3, k / 3) - 1 : ivec2((k - kNearPlaces) % 4, (k - kNearPlaces) / 4) * 2 - kReach;
}

bool isNear(ivec2 offset) { return all(lessThanEqual(abs(offset), ivec2(1))); }

// The tile with as many pixels around it as its own look at.
const int kBlockSide = int(kHistoryTileSide) + 2 * kReach, kBlockSize = kBlockSide * kBlockSide;
shared uvec4 block_guides[kBlockSize]; // SurfaceGuide
shared uvec4 block_pairs[kBlockSize][2]; // PixelPairs

/// All threads of the group take part; a barrier follows.
void loadSurroundings()
{
    ivec2 corner = tileCorner() - kReach, size = pictureSize();
    for (int i = int(gl_LocalInvocationID.x); i < kBlockSize; i += int(kHistoryTileSize))
    {
        ivec2 place = corner + ivec2(i % kBlockSide, i / kBlockSide);
        bool outside = any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size));
        int pixel = outside ? 0 : place.y * size.x + place.x;
        SurfaceGuide g = loadGuide(pixel);
        block_guides[i] = uvec4(floatBitsToUint(outside ? vec3(kInfinity) : g.position), g.normals);
        block_pairs[i][0] = texelFetch(Compared, 2 * pixel);
        block_pairs[i][1] = texelFetch(Compared, 2 * pixel + 1);
    }
}

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

void reconcileMemory(inout Memory past, Pairs far, Pairs wide, Pairs near, float shared_)
{
    Change change = Change(clamp(vec3(1.0), params.least, params.most), vec3(0.0)); // so much is sure
    past.light *= change.gain;
    float single = singleVariance(wide, past, shared_);
    follow(past, change, far, single, shared_ * kSharedFar, kChance);
    follow(past, change, wide, single, shared_, kChance);
    follow(past, change, near, single, shared_, kNearChance);
}

struct Surroundings // of a pixel, that show the same surface
{
    uint places; // bits, by k of placeOf()
    uint tiles;  // bits, row by row
};

const int kTilesAround = kTilesBeside * kTilesBeside;
ivec2 tileOf(int k) { return tilePlace() + (ivec2(k % kTilesBeside, k / kTilesBeside) - kTilesBeside / 2) * kTileStep; }

int blockIndex(int k)
{
    ivec2 place = inTile(gl_LocalInvocationID.x) + kReach + placeOf(k);
    return place.y * kBlockSide + place.x;
}

int tileIndex(int k) { return tileOf(k).y * tileCounts().x + tileOf(k).x; }

Surroundings surroundingsOf(uint pixel)
{
    SurfaceGuide guide = loadGuide(pixel);
    vec3 normal = octahedralToUnit(unpackSnorm4x8(guide.normals).xy);
    float footprint = footprintAt(motions[pixel]);
    Surroundings found = Surroundings(0u, 0u);
    for (int k = 0; k < kPlaces; ++k)
    {
        bool twice = k >= kNearPlaces && isNear(placeOf(k));
        if (!twice && sameSurface(guide, normal, block_guides[blockIndex(k)], footprint))
            found.places |= 1u << k;
    }
    for (int k = 0; k < kTilesAround; ++k)
    {
        ivec2 tile = tileOf(k);
        if (any(lessThan(tile, ivec2(0))) || any(greaterThanEqual(tile, tileCounts())))
            continue;
        SurfaceGuide g = tiles[tileIndex(k)].guide;
        if (sameSurface(guide, normal, uvec4(floatBitsToUint(g.position), g.normals), footprint))
            found.tiles |= 1u << k;
    }
    return found;
}

void addTile(inout Pairs far, TermPairs sum)
{
    far.fresh += sum.fresh;
    far.past += sum.past;
    far.count += sum.count;
}

const uint kDirectTerm = 0u, kIndirectTerm = 1u, kGlossyTerm = 2u, kCausticTerm = 3u; // in the order of PixelPairs

void addTile(inout Pairs far, int tile, uint term)
{
    if (term == kDirectTerm)
        addTile(far, tiles[tile].direct);
    else if (term == kIndirectTerm)
        addTile(far, tiles[tile].indirect);
    else if (term == kGlossyTerm)
        addTile(far, tiles[tile].glossy);
    else
        addTile(far, tiles[tile].caustics);
}

/// One term after the other: sums of all four at a time would take too many registers.
void reconcileTerm(inout Memory past, Surroundings around, uint term, float shared_)
{
    if (past.frames == 0.0)
        return;
    Pairs far = kNoPairs, wide = kNoPairs, near = kNoPairs;
    for (int k = 0; k < kPlaces; ++k)
    {
        if ((around.places >> k & 1u) == 0u)
            continue;
        uvec4 texel = block_pairs[blockIndex(k)][term / 2u];
        uvec2 words = term % 2u == 0u ? texel.xy : texel.zw;
        addPair(wide, words);
        if (k < kNearPlaces)
            addPair(near, words);
    }
    for (int k = 0; k < kTilesAround; ++k)
        if ((around.tiles >> k & 1u) != 0u)
            addTile(far, tileIndex(k), term);
    reconcileMemory(past, far, wide, near, shared_);
}

/// Compares what the surface shows around the pixel with what it showed.
void reconcile(inout Past past, uint pixel)
{
    Surroundings around = surroundingsOf(pixel);
    reconcileTerm(past.direct, around, kDirectTerm, kOwnRays);
    reconcileTerm(past.indirect, around, kIndirectTerm, kSharedSamples);
    reconcileTerm(past.glossy, around, kGlossyTerm, kOwnRays);
    reconcileTerm(past.caustics, around, kCausticTerm, kSharedSamples);
}

#endif
