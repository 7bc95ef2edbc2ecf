#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// Where light has changed since the last frame: compares what the surface around one pixel of each block shows with what it
// showed, and says what becomes of the past (lib/reconcile.glsl). One thread per block and term, one group per tile.

layout(local_size_x = kHistoryTileSize) in;
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

// The tile with as many pixels around it as its own look at, and the tiles around it.
const int kAreaSide = int(kHistoryTileSide) + 2 * kReach, kAreaSize = kAreaSide * kAreaSide;
shared vec3 positions[kAreaSize], normals[kAreaSize]; // of SurfaceGuides
shared uvec2 shown[kHistoryTerms][kAreaSize];         // LightPairs
shared SurfaceGuide tile_guides[kTilesAround];
shared TermPairs tile_pairs[kHistoryTerms][kTilesAround];
shared uint same_places[kTileBlocks], same_tiles[kTileBlocks]; // bits of those that show the surface of a block's pixel

int areaIndex(ivec2 in_tile) { return (in_tile.y + kReach) * kAreaSide + in_tile.x + kReach; }

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
    ivec2 corner = tileCorner() - kReach, size = pictureSize();
    for (int i = int(gl_LocalInvocationID.x); i < kAreaSize; i += int(kHistoryTileSize))
    {
        ivec2 place = corner + ivec2(i % kAreaSide, i / kAreaSide);
        bool outside = any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, size));
        int pixel = outside ? 0 : place.y * size.x + place.x;
        SurfaceGuide g = loadGuide(pixel);
        positions[i] = outside ? vec3(kInfinity) : g.position;
        normals[i] = smoothNormal(g.normals);
        uvec4 first = texelFetch(Compared, 2 * pixel), second = texelFetch(Compared, 2 * pixel + 1);
        shown[0][i] = first.xy;
        shown[1][i] = first.zw;
        shown[2][i] = second.xy;
        shown[3][i] = second.zw;
    }
    int k = int(gl_LocalInvocationID.x);
    if (k < int(kTileBlocks))
        same_places[k] = same_tiles[k] = 0u;
    if (k >= kTilesAround)
        return;
    ivec2 tile = tilePlace() + (ivec2(k % kTilesBeside, k / kTilesBeside) - kTilesBeside / 2) * kTileStep;
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

/// Finds the places that show the surface of a block's pixel. kHistoryTerms threads per block, each a part of them; a barrier follows.
void findPlaces(uint block, int part, ivec2 in_tile, float footprint)
{
    int here = areaIndex(in_tile);
    SurfaceGuide guide = SurfaceGuide(positions[here], 0u);
    vec3 normal = normals[here];
    uint places = 0u, tiles_ = 0u;
    for (int k = part; k < kPlaces; k += int(kHistoryTerms))
    {
        int i = areaIndex(in_tile + placeAt(k));
        if (!isTwice(k) && sameSurface(guide, normal, positions[i], normals[i], footprint))
            places |= 1u << k;
    }
    for (int k = part; k < kTilesAround; k += int(kHistoryTerms))
        if (sameSurface(guide, normal, tile_guides[k].position, smoothNormal(tile_guides[k].normals), footprint))
            tiles_ |= 1u << k;
    atomicOr(same_places[block], places);
    atomicOr(same_tiles[block], tiles_);
}

/// Compares what the surface shows around a block's pixel with what it showed. One thread per block and term.
/// @param memory frames and spread of the pixel
Followed compareTerm(uint block, uint term, ivec2 in_tile, vec2 memory)
{
    Pairs far = kNoPairs, wide = kNoPairs, near = kNoPairs;
    uint places = same_places[block], tiles_ = same_tiles[block];
    [[unroll]] for (int k = 0; k < kPlaces; ++k)
    {
        if (!isTwice(k))
            addPair(wide, (places >> k & 1u) != 0u ? shown[term][areaIndex(in_tile + placeAt(k))] : uvec2(0u));
        if (k == kNearPlaces - 1)
            near = wide;
    }
    for (int k = 0; k < kTilesAround; ++k)
        if ((tiles_ >> k & 1u) != 0u)
        {
            far.fresh += tile_pairs[term][k].fresh;
            far.past += tile_pairs[term][k].past;
            far.count += tile_pairs[term][k].count;
        }
    float shared_ = term == 1u || term == 3u ? kSharedSamples : kOwnRays; // irradiance samples and photons serve many pixels
    return followedBy(Memory(vec3(0.0), memory.x, memory.y), far, wide, near, shared_);
}

void main()
{
    uint block = gl_LocalInvocationID.x % kTileBlocks, term = gl_LocalInvocationID.x / kTileBlocks;
    HistoryBlock b = blocks[gl_WorkGroupID.x * kTileBlocks + block];
    loadSurroundings();
    barrier();
    bool is_known = b.pixel != kNoPixel;
    uint pixel = is_known ? b.pixel : 0u, row = quotient(pixel, params.width);
    ivec2 in_tile = is_known ? ivec2(pixel - row * params.width, row) - tileCorner() : ivec2(0);
    if (is_known)
        findPlaces(block, int(term), in_tile, footprintAt(motions[pixel]));
    barrier();
    vec2 memory = unpackHalf2x16(b.memories[term]);
    Followed followed = is_known && memory.x > 0.0 ? compareTerm(block, term, in_tile, memory) : kUnknown;
    uint i = (gl_WorkGroupID.x * kTileBlocks + block) * kHistoryTerms + term;
    followed_terms[i] = packFollowed(followed, hash(params.seed, ~i));
}
