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
const int kNearSide = 3, kWideSide = kReach + 1, kNearPlaces = kNearSide * kNearSide;

const int kTilesAround = kTilesBeside * kTilesBeside;
ivec2 tileOf(int k) { return tilePlace() + (ivec2(k % kTilesBeside, k / kTilesBeside) - kTilesBeside / 2) * kTileStep; }

// The tile with as many pixels around it as its own look at, and the tiles around it.
const int kBlockSide = int(kHistoryTileSide) + 2 * kReach, kBlockSize = kBlockSide * kBlockSide;
shared vec3 block_positions[kBlockSize], block_normals[kBlockSize]; // of SurfaceGuides
shared uvec4 block_pairs[2][kBlockSize];                            // PixelPairs
shared TilePairs tiles_around[kTilesAround];

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
        block_positions[i] = outside ? vec3(kInfinity) : g.position;
        block_normals[i] = smoothNormal(g.normals);
        block_pairs[0][i] = texelFetch(Compared, 2 * pixel);
        block_pairs[1][i] = texelFetch(Compared, 2 * pixel + 1);
    }
    int k = int(gl_LocalInvocationID.x);
    if (k >= kTilesAround)
        return;
    ivec2 tile = tileOf(k);
    bool outside = any(lessThan(tile, ivec2(0))) || any(greaterThanEqual(tile, tileCounts()));
    tiles_around[k] = tiles[outside ? 0 : tile.y * tileCounts().x + tile.x];
    if (outside)
        tiles_around[k].guide.position = vec3(kInfinity);
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
    if (past.frames == 0.0)
        return;
    Change change = Change(clamp(vec3(1.0), params.least, params.most), vec3(0.0)); // so much is sure
    past.light *= change.gain;
    float single = singleVariance(wide, past, shared_);
    follow(past, change, far, single, shared_ * kSharedFar, kChance);
    follow(past, change, wide, single, shared_, kChance);
    follow(past, change, near, single, shared_, kNearChance);
}

struct Surroundings // of a pixel, that show the same surface
{
    uint places; // bits: the near ones row by row, then the wide ones
    uint tiles;  // bits, row by row
};

/// In the block, of the first near place and of the first wide one.
int firstNear()
{
    ivec2 place = inTile(gl_LocalInvocationID.x) + kReach - 1;
    return place.y * kBlockSide + place.x;
}
int firstWide()
{
    ivec2 place = inTile(gl_LocalInvocationID.x);
    return place.y * kBlockSide + place.x;
}

Surroundings surroundingsOf(uint pixel)
{
    SurfaceGuide guide = loadGuide(pixel);
    vec3 normal = smoothNormal(guide.normals);
    float footprint = footprintAt(motions[pixel]);
    Surroundings found = Surroundings(0u, 0u);
    for (int y = 0; y < kNearSide; ++y)
        [[unroll]] for (int x = 0; x < kNearSide; ++x)
        {
            int i = firstNear() + y * kBlockSide + x;
            if (sameSurface(guide, normal, block_positions[i], block_normals[i], footprint))
                found.places |= 1u << (y * kNearSide + x);
        }
    for (int y = 0; y < kWideSide; ++y)
        [[unroll]] for (int x = 0; x < kWideSide; ++x)
        {
            int i = firstWide() + 2 * (y * kBlockSide + x);
            bool twice = abs(2 * y - kReach) == 1 && abs(2 * x - kReach) == 1; // a near one
            if (!twice && sameSurface(guide, normal, block_positions[i], block_normals[i], footprint))
                found.places |= 1u << (kNearPlaces + y * kWideSide + x);
        }
    for (int k = 0; k < kTilesAround; ++k)
    {
        SurfaceGuide g = tiles_around[k].guide;
        if (sameSurface(guide, normal, g.position, smoothNormal(g.normals), footprint))
            found.tiles |= 1u << k;
    }
    return found;
}

const uint kDirectTerm = 0u, kIndirectTerm = 1u, kGlossyTerm = 2u, kCausticTerm = 3u; // in the order of PixelPairs

void addTile(inout Pairs far, TermPairs sum)
{
    far.fresh += sum.fresh;
    far.past += sum.past;
    far.count += sum.count;
}

/// Of the tiles around, whose sums of the term are `of(k)`.
#define ADD_TILES(far, term) \
    for (int k = 0; k < kTilesAround; ++k) \
        if ((around.tiles >> k & 1u) != 0u) \
            addTile(far, tiles_around[k].term);

struct TwoPairs // of two terms, whose words lie in one texel
{
    Pairs first, second;
};

void addPairs(inout TwoPairs sum, uvec4 texel)
{
    addPair(sum.first, texel.xy);
    addPair(sum.second, texel.zw);
}

/// Two terms at a time: sums of all four would take too many registers, one by one would load and test all places four times.
/// @param wide of all places, @param near of the near ones among them
void sumPlaces(Surroundings around, int texel, out TwoPairs wide, out TwoPairs near)
{
    wide = TwoPairs(kNoPairs, kNoPairs);
    uint places = around.places;
    for (int y = 0; y < kNearSide; ++y)
        [[unroll]] for (int x = 0; x < kNearSide; ++x, places >>= 1)
            if ((places & 1u) != 0u)
                addPairs(wide, block_pairs[texel][firstNear() + y * kBlockSide + x]);
    near = wide;
    for (int y = 0; y < kWideSide; ++y)
        [[unroll]] for (int x = 0; x < kWideSide; ++x, places >>= 1)
            if ((places & 1u) != 0u)
                addPairs(wide, block_pairs[texel][firstWide() + 2 * (y * kBlockSide + x)]);
}

/// Compares what the surface shows around the pixel with what it showed.
void reconcile(inout Past past, uint pixel)
{
    Surroundings around = surroundingsOf(pixel);
    TwoPairs wide, near;
    sumPlaces(around, 0, wide, near);
    Pairs far = kNoPairs;
    ADD_TILES(far, direct)
    reconcileMemory(past.direct, far, wide.first, near.first, kOwnRays);
    far = kNoPairs;
    ADD_TILES(far, indirect)
    reconcileMemory(past.indirect, far, wide.second, near.second, kSharedSamples);
    sumPlaces(around, 1, wide, near);
    far = kNoPairs;
    ADD_TILES(far, glossy)
    reconcileMemory(past.glossy, far, wide.first, near.first, kOwnRays);
    far = kNoPairs;
    ADD_TILES(far, caustics)
    reconcileMemory(past.caustics, far, wide.second, near.second, kSharedSamples);
}

#endif
