// Where caustic photons should be aimed: spheres about the scene's specular objects.
#pragma once
#include "compiler/scene_data.h"

inline constexpr size_t kMaxCausticTargets = 64;

/// One bounding sphere an object with smooth metal or smooth, solid glass; neighbours share one where there are more
/// than kMaxCausticTargets. Thin-walled glass is not included: it does not bend light, and shadow rays pass it.
std::vector<gpu::CausticTarget> findCausticTargets(const SceneData& scene);
