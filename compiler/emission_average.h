// The mean of an emissive texture over one triangle.
#pragma once
#include "compiler/scene_data.h"

/// @return linear RGB mean of the material's emissive texture over `triangle`, sampled at most a texel or
///         1/128 of the triangle apart
gpu::vec3 averageEmissiveTexture(const SceneData& scene, uint32_t triangle);
