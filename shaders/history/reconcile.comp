#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// As history/blend.comp, where light has changed since the last frame: the past first follows what its surroundings show
// (lib/reconcile.glsl). One thread per pixel, one group per tile, so that pixels share what they read of their surroundings.

layout(local_size_x = kHistoryTileSize) in;
layout(push_constant, scalar) uniform Params { HistoryParams params; };

layout(set = 1, binding = 0, scalar) readonly buffer Motions { Motion motions[]; };
layout(set = 1, binding = 1) uniform usamplerBuffer Guides;
layout(set = 1, binding = 2) uniform usamplerBuffer OldGuides;
layout(set = 1, binding = 3) uniform usamplerBuffer OldHistory;
layout(set = 1, binding = 4, scalar) writeonly buffer NewHistory { PixelHistory history[]; };
layout(set = 1, binding = 5, scalar) buffer DirectSignals { uvec4 direct_signals[]; };
layout(set = 1, binding = 6, scalar) buffer GlossySignals { uvec4 glossy_signals[]; };
layout(set = 1, binding = 7) uniform usamplerBuffer DiffusePoints;
layout(set = 1, binding = 8, scalar) buffer Indirect { vec3 indirect[]; };
layout(set = 1, binding = 9, scalar) buffer Caustics { vec3 caustics[]; };
layout(set = 1, binding = 10, scalar) readonly buffer Displacements { vec3 displacements[]; };
layout(set = 1, binding = 11) uniform usamplerBuffer Compared; // PixelPairs
layout(set = 1, binding = 12, scalar) readonly buffer Tiles { TilePairs tiles[]; };

#include "shaders/lib/history_tile.glsl"
#include "shaders/lib/remember.glsl"
#include "shaders/lib/reconcile.glsl"

void main()
{
    uint thread = gl_LocalInvocationID.x;
    int quad = int(thread) % kQuads, part = int(thread) / kQuads;
    ivec2 in_tile = inTile(thread), here = tileCorner() + in_tile;
    bool inside = all(lessThan(here, pictureSize()));
    uint pixel = uint(here.y) * params.width + uint(here.x);
    loadSurroundings();
    Past past = Past(kNoMemory, kNoMemory, kNoMemory, kNoMemory);
    if (inside)
        past = recall(pixel);
    noteMemory(thread, past);
    if (part == 0)
        pickPixel(quad);
    barrier();
    findPlaces(quad, part);
    barrier();
    compareTerm(quad, uint(part));
    barrier();
    if (!inside)
        return;
    reconcile(past, pixel, in_tile);
    rememberPixel(pixel, past);
}
