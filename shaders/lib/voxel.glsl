// The places, and their sides, that tell where light is wanted: a grid over the scene's box. Functions only.
#ifndef LIB_VOXEL_GLSL
#define LIB_VOXEL_GLSL
#include "shaders/guide/guide.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"

/// The axis that a surface's normal is nearest to, and its sign.
uint sideOf(vec3 normal)
{
    vec3 size = abs(normal);
    if (size.x >= max(size.y, size.z))
        return normal.x < 0.0 ? 0u : 1u;
    if (size.y >= size.z)
        return normal.y < 0.0 ? 2u : 3u;
    return normal.z < 0.0 ? 4u : 5u;
}

/// Index of the voxel's side that a point of a surface lies on.
uint placeOf(vec3 position, vec3 normal)
{
    vec3 relative = (position - scene.bounds_min) / max(scene.bounds_max - scene.bounds_min, vec3(1e-20));
    uvec3 v = uvec3(clamp(relative * float(kGuideVoxels), vec3(0.0), vec3(float(kGuideVoxels) - 1.0)));
    return ((v.z * kGuideVoxels + v.y) * kGuideVoxels + v.x) * kGuideSides + sideOf(normal);
}

#endif
