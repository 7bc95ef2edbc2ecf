#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// Where light has changed since the last frame: what each pixel shows beside what its surface showed before, for its
// surroundings to compare, and sums of that over tiles, for what is farther away. Of each block of pixels one is picked for
// history/judge.comp. One thread per pixel, one group per tile.

layout(local_size_x = kHistoryTileSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4) uniform usamplerBuffer DirectSignals;
layout(set = 1, binding = 5) uniform usamplerBuffer GlossySignals;
layout(set = 1, binding = 6) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 7, scalar) readonly buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 8, scalar) readonly buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 9, scalar) writeonly buffer Compared { PixelPairs pairs[]; };
layout(set = 1, binding = 10, scalar) readonly buffer Displacements { vec3 displacements[]; };
layout(set = 1, binding = 11, scalar) writeonly buffer Tiles { TilePairs tiles[]; };
layout(set = 1, binding = 12, scalar) writeonly buffer Blocks { HistoryBlock blocks[]; };
layout(set = 1, binding = 13, scalar) readonly buffer Factors { float factors[]; };

#include "shaders/lib/diffuse_point.glsl"
#include "shaders/lib/history_tile.glsl"
#include "shaders/lib/recall.glsl"

shared uint chosen;                       // the thread whose surface the tile's sums are of; its distance from the centre above
shared SurfaceGuide surfaces[kHistoryTileSize];
shared LightPair shown[kHistoryTileSize][kHistoryTerms];
shared TermPairs rows[kHistoryTileSide][kHistoryTerms];
shared uint nearest[kTileBlocks]; // by block, likewise

LightPair pairOf(uvec4 bits, Memory past)
{
    Signal s = unpackSignal(bits);
    return s.lobe == 0.0 ? LightPair(uvec2(0u)) : packPair(lightOver(s.light, s.reflectance, past), past);
}

uint halves(Memory past) { return packHalf2x16(vec2(past.frames, past.spread)); }

/// @return whether it has a surface
bool comparePixel(uint pixel, uint thread, out uvec4 memories)
{
    Past past = recall(pixel);
    memories = uvec4(halves(past.direct), halves(past.indirect), halves(past.glossy), halves(past.caustics));
    vec3 reflectance = max(loadDiffusePoint(pixel).reflectance, vec3(kLeastReflectance));
    PixelPairs p = PixelPairs(pairOf(texelFetch(DirectSignals, int(pixel)), past.direct),
                              packPair(lightOver(indirect[pixel], reflectance, past.indirect), past.indirect),
                              LightPair(uvec2(0u)), LightPair(uvec2(0u)));
    if (kSceneHasGlossy)
        p.glossy = pairOf(texelFetch(GlossySignals, int(pixel)), past.glossy);
    if (kSceneHasCaustics)
        p.caustics = packPair(lightOver(caustics[pixel], reflectance, past.caustics), past.caustics);
    pairs[pixel] = p;
    surfaces[thread] = loadGuide(pixel);
    shown[thread] = LightPair[kHistoryTerms](p.direct, p.indirect, p.glossy, p.caustics);
    return motions[pixel].distance < kInfinity;
}

/// A thread of the tile, and in the bits above the distance of its pixel from the centre of a square.
uint distanceKey(ivec2 in_square, int side, uint thread)
{
    ivec2 off = 2 * in_square - side + 1; // halves of a pixel
    return uint(off.x * off.x + off.y * off.y) * kHistoryTileSize + thread;
}

TermPairs addedTo(TermPairs sum, TermPairs more) { return TermPairs(sum.fresh + more.fresh, sum.past + more.past, sum.count + more.count); }

/// Of the pixels in a row that show the surface, or of all rows.
void sumRow(uint row, uint term, SurfaceGuide surface, float footprint)
{
    vec3 normal = octahedralToUnit(unpackSnorm4x8(surface.normals).xy);
    TermPairs sum = TermPairs(vec3(0.0), vec3(0.0), 0.0);
    for (uint x = 0u; x < kHistoryTileSide; ++x)
    {
        uint other = row * kHistoryTileSide + x;
        uvec2 words = shown[other][term].words;
        SurfaceGuide g = surfaces[other];
        if (words.x != 0u && sameSurface(surface, normal, uvec4(floatBitsToUint(g.position), g.normals), footprint))
            sum = addedTo(sum, TermPairs(unpackShared(words.x), unpackShared(words.y), 1.0));
    }
    rows[row][term] = sum;
}

void main()
{
    uint thread = gl_LocalInvocationID.x;
    ivec2 here = tileCorner() + inTile(thread);
    uint pixel = uint(here.y) * params.width + uint(here.x);
    ivec2 in_tile = inTile(thread);
    uint block = blockInTile(in_tile);
    if (thread == 0u)
        chosen = ~0u;
    if (thread < kTileBlocks)
        nearest[thread] = ~0u;
    barrier();
    shown[thread] = LightPair[kHistoryTerms](LightPair(uvec2(0u)), LightPair(uvec2(0u)), LightPair(uvec2(0u)), LightPair(uvec2(0u)));
    uvec4 memories = uvec4(0u);
    if (all(lessThan(here, pictureSize())) && comparePixel(pixel, thread, memories))
    {
        atomicMin(chosen, distanceKey(in_tile, int(kHistoryTileSide), thread));
        atomicMin(nearest[block], distanceKey(in_tile % int(kBlockSide), int(kBlockSide), thread));
    }
    barrier();
    if (nearest[block] != ~0u && nearest[block] % kHistoryTileSize == thread)
        blocks[gl_WorkGroupID.x * kTileBlocks + block] = HistoryBlock(pixel, memories);
    if (thread < kTileBlocks && nearest[thread] == ~0u)
        blocks[gl_WorkGroupID.x * kTileBlocks + thread].pixel = kNoPixel;
    uint tile = gl_WorkGroupID.x;
    if (chosen == ~0u) // sky
    {
        if (thread == 0u)
            tiles[tile].guide.position = vec3(kInfinity);
        return;
    }
    uint center = chosen % kHistoryTileSize;
    ivec2 at = tileCorner() + inTile(center);
    if (thread < kHistoryTileSide * kHistoryTerms)
        sumRow(thread / kHistoryTerms, thread % kHistoryTerms, surfaces[center], footprintAt(motions[at.y * int(params.width) + at.x]));
    barrier();
    if (thread >= kHistoryTerms)
        return;
    TermPairs sum = rows[0][thread];
    for (uint row = 1u; row < kHistoryTileSide; ++row)
        sum = addedTo(sum, rows[row][thread]);
    if (thread == 0u)
    {
        tiles[tile].guide = surfaces[center];
        tiles[tile].direct = sum;
    }
    else if (thread == 1u)
        tiles[tile].indirect = sum;
    else if (thread == 2u)
        tiles[tile].glossy = sum;
    else
        tiles[tile].caustics = sum;
}
