// The grid over the scene's box that tells where light is wanted. Functions only.
#ifndef LIB_VOXEL_GLSL
#define LIB_VOXEL_GLSL
#include "shaders/guide/guide.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/scene.glsl"

uint voxelAt(vec3 position)
{
    vec3 relative = (position - scene.bounds_min) / max(scene.bounds_max - scene.bounds_min, vec3(1e-20));
    uvec3 v = uvec3(clamp(relative * float(kGuideVoxels), vec3(0.0), vec3(float(kGuideVoxels) - 1.0)));
    return (v.z * kGuideVoxels + v.y) * kGuideVoxels + v.x;
}

/// A bit for the one of the six axes that n is nearest to: both sides of a thin wall lie in one voxel, and may not both be
/// wanted.
uint facingBit(vec3 n)
{
    vec3 size = abs(n);
    if (size.x >= max(size.y, size.z))
        return n.x < 0.0 ? 1u : 2u;
    if (size.y >= size.z)
        return n.y < 0.0 ? 4u : 8u;
    return n.z < 0.0 ? 16u : 32u;
}

#endif
