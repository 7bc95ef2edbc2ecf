// The importance map's bins: voxels of a grid over the scene, and their sides. Functions only.
#ifndef LIB_VOXEL_GLSL
#define LIB_VOXEL_GLSL
#include "shaders/guide/guide.h"
#include "shaders/lib/math.glsl"
#include "shaders/lib/morton.glsl"
#include "shaders/lib/side.glsl"

/// Index of the voxel's side that a point of a surface lies on.
uint binOf(vec3 position, vec3 normal)
{
    uvec3 v = uvec3(min(gridPlace(position) * float(kGuideVoxels), vec3(float(kGuideVoxels) - 1.0)));
    return ((v.z * kGuideVoxels + v.y) * kGuideVoxels + v.x) * kGuideSides + sideOf(normal);
}

#endif
