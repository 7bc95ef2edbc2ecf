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
const int kNearSide = 3, kWideSide = kReach + 1, kNearPlaces = kNearSide * kNearSide, kPlaces = kNearPlaces + kWideSide * kWideSide;
const int kTilesAround = kTilesBeside * kTilesBeside;

// One pixel of each block of 2 x 2 is compared with its surroundings; those of its block that show the same surface follow it. A thread
// works on one term of one block: so all four terms of a tile take as many threads as it has pixels.
const int kQuadsAlong = int(kHistoryTileSide) / 2, kQuads = kQuadsAlong * kQuadsAlong;
const uint kTerms = 4u; // in the order of PixelPairs

struct Followed // what becomes of a term's past: light -> gain x light + more
{
    vec3 gain, more;
    float frames; // factor; less than 0: nothing is known
};

// The tile with as many pixels around it as its own look at, and the tiles around it.
const int kBlockSide = int(kHistoryTileSide) + 2 * kReach, kBlockSize = kBlockSide * kBlockSide;
shared vec3 block_positions[kBlockSize], block_normals[kBlockSize]; // of SurfaceGuides
shared uvec2 block_pairs[kTerms][kBlockSize];                       // LightPairs
shared SurfaceGuide tile_guides[kTilesAround];
shared TermPairs tile_pairs[kTerms][kTilesAround];
shared vec2 memories[kTerms][kHistoryTileSize]; // frames and spread of the tile's pixels
shared int quad_pixels[kQuads];                 // which pixel of the tile is compared; -1: none shows a surface
shared float quad_footprints[kQuads];
shared uint quad_places[kQuads], quad_tiles[kQuads]; // bits of those that show its surface
shared Followed quad_followed[kTerms][kQuads];

ivec2 tileOf(int k) { return tilePlace() + (ivec2(k % kTilesBeside, k / kTilesBeside) - kTilesBeside / 2) * kTileStep; }

int blockIndex(ivec2 in_tile) { return (in_tile.y + kReach) * kBlockSide + in_tile.x + kReach; }

/// Of place k around a pixel of the tile.
int blockIndex(ivec2 in_tile, int k)
{
    ivec2 near = ivec2(k % kNearSide, k / kNearSide) - 1, wide = 2 * ivec2((k - kNearPlaces) % kWideSide, (k - kNearPlaces) / kWideSide) - kReach;
    return blockIndex(in_tile + (k < kNearPlaces ? near : wide));
}

/// Whether a wide place is a near one, too.
bool isTwice(int k)
{
    ivec2 wide = 2 * ivec2((k - kNearPlaces) % kWideSide, (k - kNearPlaces) / kWideSide) - kReach;
    return k >= kNearPlaces && all(lessThanEqual(abs(wide), ivec2(1)));
}

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
        uvec4 first = texelFetch(Compared, 2 * pixel), second = texelFetch(Compared, 2 * pixel + 1);
        block_pairs[0][i] = first.xy;
        block_pairs[1][i] = first.zw;
        block_pairs[2][i] = second.xy;
        block_pairs[3][i] = second.zw;
    }
    int k = int(gl_LocalInvocationID.x);
    if (k >= kTilesAround)
        return;
    ivec2 tile = tileOf(k);
    bool outside = any(lessThan(tile, ivec2(0))) || any(greaterThanEqual(tile, tileCounts()));
    TilePairs around = tiles[outside ? 0 : tile.y * tileCounts().x + tile.x];
    if (outside)
        around.guide.position = vec3(kInfinity);
    tile_guides[k] = around.guide;
    tile_pairs[0][k] = around.direct;
    tile_pairs[1][k] = around.indirect;
    tile_pairs[2][k] = around.glossy;
    tile_pairs[3][k] = around.caustics;
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

/// Notes a pixel of the tile for its block. A barrier follows.
void noteMemory(uint thread, Past past)
{
    memories[0][thread] = vec2(past.direct.frames, past.direct.spread);
    memories[1][thread] = vec2(past.indirect.frames, past.indirect.spread);
    memories[2][thread] = vec2(past.glossy.frames, past.glossy.spread);
    memories[3][thread] = vec2(past.caustics.frames, past.caustics.spread);
}

int quadOf(ivec2 in_tile) { return in_tile.y / 2 * kQuadsAlong + in_tile.x / 2; }

/// Picks the first pixel of a block that shows a surface. One thread per block; a barrier follows.
void pickPixel(int quad)
{
    quad_pixels[quad] = -1;
    quad_places[quad] = quad_tiles[quad] = 0u;
    for (int k = 3; k >= 0; --k)
    {
        ivec2 in_tile = 2 * ivec2(quad % kQuadsAlong, quad / kQuadsAlong) + ivec2(k & 1, k >> 1);
        ivec2 here = tileCorner() + in_tile;
        if (any(greaterThanEqual(here, pictureSize())))
            continue;
        Motion motion = motions[here.y * int(params.width) + here.x];
        if (!(motion.distance < kInfinity))
            continue;
        quad_pixels[quad] = in_tile.y * int(kHistoryTileSide) + in_tile.x;
        quad_footprints[quad] = footprintAt(motion);
    }
}

/// Finds the places that show the surface of a block's pixel. kTerms threads per block, each a part of them; a barrier follows.
void findPlaces(int quad, int part)
{
    if (quad_pixels[quad] < 0)
        return;
    ivec2 in_tile = inTile(uint(quad_pixels[quad]));
    int here = blockIndex(in_tile);
    SurfaceGuide guide = SurfaceGuide(block_positions[here], 0u);
    vec3 normal = block_normals[here];
    float footprint = quad_footprints[quad];
    uint places = 0u, tiles_ = 0u;
    for (int k = part; k < kPlaces; k += int(kTerms))
    {
        int i = blockIndex(in_tile, k);
        if (!isTwice(k) && sameSurface(guide, normal, block_positions[i], block_normals[i], footprint))
            places |= 1u << k;
    }
    for (int k = part; k < kTilesAround; k += int(kTerms))
        if (sameSurface(guide, normal, tile_guides[k].position, smoothNormal(tile_guides[k].normals), footprint))
            tiles_ |= 1u << k;
    atomicOr(quad_places[quad], places);
    atomicOr(quad_tiles[quad], tiles_);
}

/// Compares what the surface shows around a block's pixel with what it showed. One thread per block and term; a barrier follows.
void compareTerm(int quad, uint term)
{
    quad_followed[term][quad].frames = -1.0;
    if (quad_pixels[quad] < 0 || memories[term][quad_pixels[quad]].x == 0.0)
        return;
    ivec2 in_tile = inTile(uint(quad_pixels[quad]));
    Pairs far = kNoPairs, wide = kNoPairs, near = kNoPairs;
    for (int k = 0; k < kPlaces; ++k)
    {
        if ((quad_places[quad] >> k & 1u) != 0u)
            addPair(wide, block_pairs[term][blockIndex(in_tile, k)]);
        if (k == kNearPlaces - 1)
            near = wide;
    }
    for (int k = 0; k < kTilesAround; ++k)
        if ((quad_tiles[quad] >> k & 1u) != 0u)
        {
            far.fresh += tile_pairs[term][k].fresh;
            far.past += tile_pairs[term][k].past;
            far.count += tile_pairs[term][k].count;
        }
    vec2 memory = memories[term][quad_pixels[quad]];
    float shared_ = term == 1u || term == 3u ? kSharedSamples : kOwnRays; // irradiance samples and photons serve many pixels
    quad_followed[term][quad] = followedBy(Memory(vec3(0.0), memory.x, memory.y), far, wide, near, shared_);
}

/// The block whose pixel shows the same surface as this one: its own, or one beside it in the tile. @return -1: none
int quadLike(uint pixel, ivec2 in_tile)
{
    int here = blockIndex(in_tile), found = -1;
    SurfaceGuide guide = SurfaceGuide(block_positions[here], 0u);
    float footprint = footprintAt(motions[pixel]);
    const ivec2 kBeside[5] = ivec2[5](ivec2(0), ivec2(-2, 0), ivec2(2, 0), ivec2(0, -2), ivec2(0, 2));
    for (int k = 0; k < 5; ++k)
    {
        ivec2 place = in_tile + kBeside[k];
        if (found >= 0 || any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, ivec2(kHistoryTileSide))))
            continue;
        int quad = quadOf(place);
        if (quad_pixels[quad] < 0)
            continue;
        int other = blockIndex(inTile(uint(quad_pixels[quad])));
        if (sameSurface(guide, block_normals[here], block_positions[other], block_normals[other], footprint))
            found = quad;
    }
    return found;
}

// Frames that a past keeps of which nothing around tells whether it still holds: it lags no longer.
const float kUnjudged = 4.0;

void reconcileMemory(inout Memory past, int quad, uint term)
{
    Followed followed = quad_followed[term][max(quad, 0)];
    if (quad < 0 || followed.frames < 0.0)
    {
        past.light *= clamp(vec3(1.0), params.least, params.most); // so much is sure
        past.frames = min(past.frames, kUnjudged);
        return;
    }
    past.light = followed.gain * past.light + followed.more;
    past.frames *= followed.frames;
}

/// The group's last step, of each pixel.
void reconcile(inout Past past, uint pixel, ivec2 in_tile)
{
    int quad = quadLike(pixel, in_tile);
    reconcileMemory(past.direct, quad, 0u);
    reconcileMemory(past.indirect, quad, 1u);
    reconcileMemory(past.glossy, quad, 2u);
    reconcileMemory(past.caustics, quad, 3u);
}

#endif
