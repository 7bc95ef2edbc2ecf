#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/light_terms.glsl"
#include "shaders/lib/signal.glsl"

// Where light has changed since the last frame: compares what the surface around one pixel of each block shows with what it
// showed, and says what becomes of the past (lib/reconcile.glsl). One thread per block and term, one group per square of tiles.

layout(local_size_x = kJudgeSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer Compared; // PixelPairs
layout(set = 1, binding = 3, scalar) readonly buffer Tiles { TilePairs tiles[]; };
layout(set = 1, binding = 4, scalar) readonly buffer Blocks { HistoryBlock blocks[]; };
layout(set = 1, binding = 5, scalar) writeonly buffer FollowedTerms { FollowedTerm followed_terms[]; };

#include "shaders/lib/history_tile.glsl"
#include "shaders/lib/reconcile.glsl"
#include "shaders/lib/same_surface.glsl"

const int kReach = 3; // pixels to each side: fewer tell less, more blur what has changed
const int kTilesBeside = 3, kTileStep = 2; // along either axis, and how far apart: tiles that show what has changed everywhere

// Places that tell of a pixel's surroundings: all next to it, then every second one up to kReach along either axis. All pixels up
// to kReach would take twice as long.
const int kNearSide = 3, kWideSide = kReach + 1, kNearPlaces = kNearSide * kNearSide, kPlaces = kNearPlaces + kWideSide * kWideSide;
const int kTilesAround = kTilesBeside * kTilesBeside;

// The group's tiles with as many pixels around them as their own look at, and the tiles around them.
const int kGroupSide = int(kJudgeTilesAlong * kHistoryTileSide), kAreaSide = kGroupSide + 2 * kReach, kAreaSize = kAreaSide * kAreaSide;
const int kTileReach = kTilesBeside / 2 * kTileStep, kTileAreaSide = int(kJudgeTilesAlong) + 2 * kTileReach, kTileAreaSize = kTileAreaSide * kTileAreaSide;
const uint kGroupBlocksAlong = kJudgeTilesAlong * kTileBlocksAlong, kGroupBlocks = kGroupBlocksAlong * kGroupBlocksAlong;
shared vec3 positions[kAreaSize], normals[kAreaSize]; // of SurfaceGuides
shared uvec2 shown[kHistoryTerms][kAreaSize];         // LightPairs
shared SurfaceGuide tile_guides[kTileAreaSize];
shared TermPairs tile_pairs[kHistoryTerms][kTileAreaSize];
shared uint same_places[kGroupBlocks], same_tiles[kGroupBlocks]; // bits of those that show the surface of a block's pixel

/// The group's first tile.
ivec2 groupTile()
{
    int columns = (tileCounts().x + int(kJudgeTilesAlong) - 1) / int(kJudgeTilesAlong);
    return ivec2(int(gl_WorkGroupID.x) % columns, int(gl_WorkGroupID.x) / columns) * int(kJudgeTilesAlong);
}
int tileIndex(ivec2 tile) { return tile.y * tileCounts().x + tile.x; }
bool isTile(ivec2 tile) { return all(greaterThanEqual(tile, ivec2(0))) && all(lessThan(tile, tileCounts())); }
/// A block's tile, in tiles from the group's first one.
ivec2 tileInGroup(uint block) { return ivec2(block % kGroupBlocksAlong, block / kGroupBlocksAlong) / int(kTileBlocksAlong); }

/// @param at in pixels from the group's first one
int areaIndex(ivec2 at) { return (at.y + kReach) * kAreaSide + at.x + kReach; }
/// Tile k around one of the group's.
int tileAreaIndex(ivec2 in_group, int k)
{
    ivec2 at = in_group + ivec2(k % kTilesBeside, k / kTilesBeside) * kTileStep;
    return at.y * kTileAreaSide + at.x;
}

/// Place k around a pixel, in pixels from it.
ivec2 placeAt(int k)
{
    ivec2 near = ivec2(k % kNearSide, k / kNearSide) - 1, wide = 2 * ivec2((k - kNearPlaces) % kWideSide, (k - kNearPlaces) / kWideSide) - kReach;
    return k < kNearPlaces ? near : wide;
}

/// Whether a wide place is a near one, too.
bool isTwice(int k) { return k >= kNearPlaces && all(lessThanEqual(abs(placeAt(k)), ivec2(1))); }

/// All threads of the group take part; a barrier follows.
void loadSurroundings()
{
    ivec2 corner = groupTile() * int(kHistoryTileSide) - kReach, size = pictureSize();
    for (int i = int(gl_LocalInvocationID.x); i < kAreaSize; i += int(kJudgeSize))
    {
        ivec2 place = corner + ivec2(i % kAreaSide, i / kAreaSide);
        bool outside = any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size));
        int pixel = outside ? 0 : place.y * size.x + place.x;
        SurfaceGuide g = loadGuide(pixel);
        positions[i] = outside ? vec3(kInfinity) : g.position;
        normals[i] = smoothNormal(g.normals);
        uvec4 first = texelFetch(Compared, 2 * pixel);
        shown[0][i] = first.xy;
        shown[1][i] = first.zw;
        if (!kSceneHasGlossy && !kSceneHasCaustics)
            continue;
        uvec4 second = texelFetch(Compared, 2 * pixel + 1);
        shown[2][i] = second.xy;
        shown[3][i] = second.zw;
    }
    int k = int(gl_LocalInvocationID.x);
    if (k < int(kGroupBlocks))
        same_places[k] = same_tiles[k] = 0u;
    if (k >= kTileAreaSize)
        return;
    ivec2 tile = groupTile() - kTileReach + ivec2(k % kTileAreaSide, k / kTileAreaSide);
    TilePairs around = tiles[isTile(tile) ? tileIndex(tile) : 0];
    if (!isTile(tile))
        around.guide.position = vec3(kInfinity);
    tile_guides[k] = around.guide;
    tile_pairs[0][k] = around.direct;
    tile_pairs[1][k] = around.indirect;
    tile_pairs[2][k] = around.glossy;
    tile_pairs[3][k] = around.caustics;
}

/// Finds the places that show the surface of a block's pixel. kHistoryTerms threads per block, each a part of them; a barrier follows.
/// @param at of the pixel, in pixels from the group's first one
void findPlaces(uint block, int part, ivec2 at, float footprint)
{
    int here = areaIndex(at);
    SurfaceGuide guide = SurfaceGuide(positions[here], 0u);
    vec3 normal = normals[here];
    uint places = 0u, tiles_ = 0u;
    for (int k = part; k < kPlaces; k += int(kHistoryTerms))
    {
        int i = areaIndex(at + placeAt(k));
        if (!isTwice(k) && sameSurface(guide, normal, positions[i], normals[i], footprint))
            places |= 1u << k;
    }
    for (int k = part; k < kTilesAround; k += int(kHistoryTerms))
    {
        SurfaceGuide around = tile_guides[tileAreaIndex(tileInGroup(block), k)];
        if (sameSurface(guide, normal, around.position, smoothNormal(around.normals), footprint))
            tiles_ |= 1u << k;
    }
    atomicOr(same_places[block], places);
    atomicOr(same_tiles[block], tiles_);
}

/// Compares what the surface shows around a block's pixel with what it showed. One thread per block and term.
/// @param memory frames and spread of the pixel
Followed compareTerm(uint block, uint term, ivec2 at, vec2 memory)
{
    Pairs far = kNoPairs, wide = kNoPairs, near = kNoPairs;
    uint places = same_places[block], tiles_ = same_tiles[block];
    [[unroll]] for (int k = 0; k < kPlaces; ++k)
    {
        if (!isTwice(k))
            addPair(wide, (places >> k & 1u) != 0u ? shown[term][areaIndex(at + placeAt(k))] : uvec2(0u));
        if (k == kNearPlaces - 1)
            near = wide;
    }
    for (int k = 0; k < kTilesAround; ++k)
        if ((tiles_ >> k & 1u) != 0u)
        {
            TermPairs around = tile_pairs[term][tileAreaIndex(tileInGroup(block), k)];
            far.fresh += around.fresh;
            far.past += around.past;
            far.count += around.count;
        }
    float shared_ = term == 1u || term == 3u ? kSharedSamples : kOwnRays; // irradiance samples and photons serve many pixels
    return followedBy(Memory(vec3(0.0), memory.x, memory.y), far, wide, near, shared_);
}

void main()
{
    uint block = gl_LocalInvocationID.x % kGroupBlocks, term = gl_LocalInvocationID.x / kGroupBlocks;
    ivec2 tile = groupTile() + tileInGroup(block), in_tile = 2 * ivec2(block % kGroupBlocksAlong, block / kGroupBlocksAlong) % int(kHistoryTileSide);
    bool is_there = isTile(tile);
    uint stored = (is_there ? uint(tileIndex(tile)) : 0u) * kTileBlocks + blockInTile(in_tile);
    HistoryBlock b = blocks[stored];
    loadSurroundings();
    barrier();
    bool is_known = is_there && b.pixel != kNoPixel;
    uint pixel = is_known ? b.pixel : 0u, row = quotient(pixel, params.width);
    ivec2 at = is_known ? ivec2(pixel - row * params.width, row) - groupTile() * int(kHistoryTileSide) : ivec2(0);
    if (is_known)
        findPlaces(block, int(term), at, footprintAt(motions[pixel]));
    barrier();
    vec2 memory = unpackHalf2x16(b.memories[term]);
    Followed followed = is_known && memory.x > 0.0 && sceneHas(term) ? compareTerm(block, term, at, memory) : kUnknown;
    uint i = stored * kHistoryTerms + term;
    if (is_there)
        followed_terms[i] = packFollowed(followed, hash(params.seed, ~i));
}
