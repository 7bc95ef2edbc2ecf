#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/light_terms.glsl"
#include "shaders/lib/signal.glsl"

// Where light has changed since the last frame: compares what the surface around one pixel of each block shows with what it
// showed, and says what becomes of the past (lib/reconcile.glsl). One thread per block and term.

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

shared uint same_places[kJudgeBlocks], same_tiles[kJudgeBlocks]; // bits of those that show the surface of a block's pixel

/// Place k around a pixel, in pixels from it.
ivec2 placeAt(int k)
{
    ivec2 near = ivec2(k % kNearSide, k / kNearSide) - 1, wide = 2 * ivec2((k - kNearPlaces) % kWideSide, (k - kNearPlaces) / kWideSide) - kReach;
    return k < kNearPlaces ? near : wide;
}

/// Whether a wide place is a near one, too.
bool isTwice(int k) { return k >= kNearPlaces && all(lessThanEqual(abs(placeAt(k)), ivec2(1))); }

/// Tile k around a tile. @return -1: it is outside of the picture
int tileAround(ivec2 tile, int k)
{
    ivec2 at = tile + (ivec2(k % kTilesBeside, k / kTilesBeside) - kTilesBeside / 2) * kTileStep;
    bool outside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, tileCounts()));
    return outside ? -1 : at.y * tileCounts().x + at.x;
}

/// Finds the places that show the surface of a block's pixel. kHistoryTerms threads per block, each a part of them; a barrier follows.
void findPlaces(uint block, int part, ivec2 at, ivec2 tile, float footprint)
{
    ivec2 size = pictureSize();
    SurfaceGuide guide = loadGuide(uint(at.y * size.x + at.x));
    vec3 normal = smoothNormal(guide.normals);
    uint places = 0u, tiles_ = 0u;
    for (int k = part; k < kPlaces; k += int(kHistoryTerms))
    {
        ivec2 place = at + placeAt(k);
        bool outside = any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size));
        if (!outside && !isTwice(k) && sameSurface(guide, normal, texelFetch(Guides, place.y * size.x + place.x), footprint))
            places |= 1u << k;
    }
    for (int k = part; k < kTilesAround; k += int(kHistoryTerms))
    {
        int around = tileAround(tile, k);
        SurfaceGuide other = tiles[max(around, 0)].guide;
        if (around >= 0 && sameSurface(guide, normal, other.position, smoothNormal(other.normals), footprint))
            tiles_ |= 1u << k;
    }
    atomicOr(same_places[block], places);
    atomicOr(same_tiles[block], tiles_);
}

TermPairs tilePairs(int tile, uint term)
{
    if (term == 0u)
        return tiles[tile].direct;
    if (term == 1u)
        return tiles[tile].indirect;
    if (term == 2u)
        return tiles[tile].glossy;
    return tiles[tile].caustics;
}

/// Compares what the surface shows around a block's pixel with what it showed. One thread per block and term.
/// @param memory frames and spread of the pixel
Followed compareTerm(uint block, uint term, ivec2 at, ivec2 tile, vec2 memory)
{
    Pairs far = kNoPairs, wide = kNoPairs, near = kNoPairs;
    uint places = same_places[block], tiles_ = same_tiles[block];
    int row = pictureSize().x, here = at.y * row + at.x;
    [[unroll]] for (int k = 0; k < kPlaces; ++k)
    {
        if (!isTwice(k))
        {
            bool same = (places >> k & 1u) != 0u;
            uvec4 pairs = texelFetch(Compared, 2 * (same ? here + placeAt(k).y * row + placeAt(k).x : here) + int(term / 2u));
            addPair(wide, same ? ((term & 1u) == 0u ? pairs.xy : pairs.zw) : uvec2(0u));
        }
        if (k == kNearPlaces - 1)
            near = wide;
    }
    for (int k = 0; k < kTilesAround; ++k)
        if ((tiles_ >> k & 1u) != 0u)
        {
            TermPairs around = tilePairs(tileAround(tile, k), term);
            far.fresh += around.fresh;
            far.past += around.past;
            far.count += around.count;
        }
    float shared_ = term == 1u || term == 3u ? kSharedSamples : kOwnRays; // irradiance samples and photons serve many pixels
    return followedBy(Memory(vec3(0.0), memory.x, memory.y), far, wide, near, shared_);
}

void main()
{
    uint thread = gl_LocalInvocationID.x, block = thread % kJudgeBlocks, term = thread / kJudgeBlocks;
    if (thread < kJudgeBlocks)
        same_places[thread] = same_tiles[thread] = 0u;
    uint stored = gl_WorkGroupID.x * kJudgeBlocks + block, block_count = uint(tileCounts().x * tileCounts().y) * kTileBlocks;
    bool is_there = stored < block_count;
    HistoryBlock b = blocks[is_there ? stored : 0u];
    bool is_known = is_there && b.pixel != kNoPixel;
    uint pixel = is_known ? b.pixel : 0u, row = quotient(pixel, params.width);
    ivec2 at = ivec2(pixel - row * params.width, row), tile = at / int(kHistoryTileSide);
    barrier();
    if (is_known)
        findPlaces(block, int(term), at, tile, footprintAt(motions[pixel]));
    barrier();
    vec2 memory = unpackHalf2x16(b.memories[term]);
    Followed followed = is_known && memory.x > 0.0 && sceneHas(term) ? compareTerm(block, term, at, tile, memory) : kUnknown;
    uint i = stored * kHistoryTerms + term;
    if (is_there)
        followed_terms[i] = packFollowed(followed, hash(params.seed, ~i));
}
