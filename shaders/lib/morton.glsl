// A grid over the scene that is fine near the viewer and coarse far away, and Morton codes of its cells. Functions only.
#ifndef LIB_MORTON_GLSL
#define LIB_MORTON_GLSL
#include "shaders/lib/scene.glsl"

/// Coordinates of which a unit is as long as things are far: metres in view distances near the focus, logarithms beyond.
vec3 bent(vec3 p) { return asinh((p - view_scale.focus) / view_scale.distance); }

/// Where p lies in the cube around the scene in those coordinates, 0 to 1. A room beside a plain of kilometres takes a good
/// part of the cube, and so does a scene that is all in view.
vec3 gridPlace(vec3 p)
{
    vec3 low = bent(scene.bounds_min), extent = bent(scene.bounds_max) - low;
    return clamp((bent(p) - low) / max(max(extent.x, max(extent.y, extent.z)), 1e-6), 0.0, 1.0);
}

uint spreadBits(uint x) // ten bits, two zeroes before each
{
    x = (x | (x << 16)) & 0x030000ffu;
    x = (x | (x << 8)) & 0x0300f00fu;
    x = (x | (x << 4)) & 0x030c30c3u;
    return (x | (x << 2)) & 0x09249249u;
}

/// 30 bits, 10 an axis.
uint mortonCode(vec3 p)
{
    uvec3 cell = min(uvec3(gridPlace(p) * 1024.0), uvec3(1023u));
    return spreadBits(cell.x) << 2 | spreadBits(cell.y) << 1 | spreadBits(cell.z);
}

#endif
