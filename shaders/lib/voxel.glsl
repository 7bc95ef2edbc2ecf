// The grid over the scene's box that tells where light is wanted. Functions only.
#ifndef LIB_VOXEL_GLSL
#define LIB_VOXEL_GLSL
#include "shaders/guide/guide.h"
#include "shaders/lib/scene.glsl"

uint voxelAt(vec3 position)
{
    vec3 relative = (position - scene.bounds_min) / max(scene.bounds_max - scene.bounds_min, vec3(1e-20));
    uvec3 v = uvec3(clamp(relative * float(kGuideVoxels), vec3(0.0), vec3(float(kGuideVoxels) - 1.0)));
    return (v.z * kGuideVoxels + v.y) * kGuideVoxels + v.x;
}

#endif
