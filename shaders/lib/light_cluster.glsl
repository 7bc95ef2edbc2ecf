// Choosing lights of a cluster, and the tile that knows which clusters a pixel sees. The kernel declares the usamplerBuffers
// Clusters and Picks before it includes this. Functions only.
#ifndef LIB_LIGHT_CLUSTER_GLSL
#define LIB_LIGHT_CLUSTER_GLSL
#include "shaders/direct/survey.h"
#include "shaders/lib/lights.glsl"

LightCluster loadCluster(uint index)
{
    uvec4 a = texelFetch(Clusters, int(index));
    return LightCluster(a.x, a.y, uintBitsToFloat(a.z), a.w);
}

LightPick loadPick(uint index)
{
    uvec4 a = texelFetch(Picks, int(index));
    return LightPick(a.x, uintBitsToFloat(a.y), a.z, 0u);
}

/// Picks a light of the cluster by power and a point or direction on it; densities are those within the cluster.
LightSample sampleCluster(LightCluster cluster, vec3 point, LightDraws draws)
{
    LightPick pick = loadPick(cluster.first_pick + toIndex(draws.pick.x, cluster.pick_count));
    LightSample light =
        sampleLightAt(toUnitFloat(draws.pick.y) < pick.threshold ? pick.light : pick.otherwise, point, draws);
    light.weight *= cluster.share;
    light.pdf /= cluster.share;
    return light;
}

/// Tiles side by side along `pixels`.
uint tileColumns(uint pixels) { return (pixels + kSurveySide - 1u) / kSurveySide; }

/// One of the tiles around a pixel, the likelier the nearer: so that no border between tiles shows. @param u in [0, 1)^2
uint tileNear(uint pixel, uint width, uint height, vec2 u)
{
    vec2 at = (vec2(pixel - quotient(pixel, width) * width, quotient(pixel, width)) + 0.5) / float(kSurveySide) + u - 0.5;
    uvec2 tiles = uvec2(tileColumns(width), tileColumns(height));
    uvec2 tile = uvec2(clamp(ivec2(floor(at)), ivec2(0), ivec2(tiles) - 1));
    return tile.y * tiles.x + tile.x;
}

#endif
