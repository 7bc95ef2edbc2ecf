// Where caustic photons should be aimed: spheres about the scene's specular objects.
#pragma once
#include "compiler/scene_data.h"

inline constexpr size_t kMaxCausticTargets = 64;
inline constexpr size_t kMaxMovingTargets = 48; // objects that move and have a sphere each

struct CausticTargets
{
    std::vector<gpu::CausticTarget> spheres;
    std::vector<int> of_object; // [object] its own sphere; -1: it has none, or shares one
};

/// One bounding sphere an object with smooth metal or smooth, solid glass; neighbours share one where there are more
/// than kMaxCausticTargets; those that move only with others where more than kMaxMovingTargets of them are. Thin-walled glass is not included: it does not bend light, and shadow rays pass it.
CausticTargets findCausticTargets(const SceneData& scene);
