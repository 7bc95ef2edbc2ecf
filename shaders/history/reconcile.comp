#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/lib/light_pair.glsl"
#include "shaders/lib/signal.glsl"

// As history/blend.comp, where light has changed since the last frame: the past first follows what its surroundings show, as
// history/judge.comp found. One thread per pixel.

layout(local_size_x = kRaysGroupSize) in;
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
layout(set = 1, binding = 11, scalar) readonly buffer Blocks { HistoryBlock blocks[]; };
layout(set = 1, binding = 12) uniform usamplerBuffer FollowedTerms;
layout(set = 1, binding = 13, scalar) readonly buffer Factors { float factors[]; };

#include "shaders/lib/history_tile.glsl"
#include "shaders/lib/remember.glsl"
#include "shaders/lib/reconcile.glsl"

// Frames that a past keeps of which nothing around tells whether it still holds: it lags no longer.
const float kUnjudged = 4.0;

/// The block whose pixel shows the same surface as this one: its own, or one beside it. @return kNoPixel: none
uint blockLike(uint pixel, ivec2 here)
{
    SurfaceGuide guide = loadGuide(pixel);
    vec3 normal = smoothNormal(guide.normals);
    float footprint = footprintAt(motions[pixel]);
    ivec2 size = pictureSize();
    uint found = kNoPixel;
    for (int k = 0;;) // tests at its end: see lib/bvh.glsl why
    {
        ivec2 step_ = k == 0 ? ivec2(0) : (1 - (k & 1) * 2) * int(kBlockSide) * (k < 3 ? ivec2(1, 0) : ivec2(0, 1));
        ivec2 place = clamp(here + step_, ivec2(0), size - 1), tile = place / int(kHistoryTileSide);
        uint block = uint(tile.y * tileCounts().x + tile.x) * kTileBlocks + blockInTile(place % int(kHistoryTileSide));
        uint other = blocks[block].pixel;
        if (other != kNoPixel && sameSurface(guide, normal, texelFetch(Guides, int(other)), footprint))
            found = block;
        if (++k == 5 || found != kNoPixel)
            break;
    }
    return found;
}

void reconcileMemory(inout Memory past, uint block, uint term)
{
    if (!sceneHas(term))
        return;
    Followed followed = kUnknown;
    if (block != kNoPixel)
        followed = unpackFollowed(texelFetch(FollowedTerms, int(block * kHistoryTerms + term)));
    if (followed.frames < 0.0)
    {
        past.light *= clamp(vec3(1.0), params.least, params.most); // so much is sure
        past.frames = min(past.frames, kUnjudged);
        return;
    }
    past.light = followed.gain * past.light + followed.more;
    past.frames *= followed.frames;
}

void main()
{
    uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= params.point_count)
        return;
    Past past = recall(pixel);
    uint row = quotient(pixel, params.width), block = blockLike(pixel, ivec2(pixel - row * params.width, row));
    reconcileMemory(past.direct, block, 0u);
    reconcileMemory(past.indirect, block, 1u);
    reconcileMemory(past.glossy, block, 2u);
    reconcileMemory(past.caustics, block, 3u);
    rememberPixel(pixel, past);
}
