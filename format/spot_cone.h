// A spot light's falloff as kernels evaluate it (gpu_scene.h, KHR_lights_punctual).
#pragma once
#include "format/gpu_types.h"

#include <algorithm>
#include <cmath>

namespace package
{
/// Light.p2 of a spot light whose cones have these half angles, in radians.
inline gpu::vec3 spotCone(float inner, float outer)
{
    const float cos_outer = std::cos(outer);
    const float scale = 1 / std::max(0.001f, std::cos(inner) - cos_outer);
    return {scale, -cos_outer * scale, 0};
}
} // namespace package
