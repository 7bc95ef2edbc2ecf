// Light data: one list of all lights with their power alias table, and where caustic photons should be aimed.
#pragma once
#include "compiler/scene_data.h"

struct LightTables
{
    std::vector<gpu::Light> lights;       // punctual, then emissive triangles, then the environment
    std::vector<gpu::AliasEntry> aliases; // [lights.size()]
    std::vector<gpu::CausticTarget> caustic_targets;
    std::vector<int> caustic_target_of; // [object] its own one; -1: it has none, or shares one
    std::vector<uint32_t> of_punctual;  // [punctual light of the scene] its number, gpu::kNone: it was left out
    std::vector<float> powers;          // [lights.size()] W, luminance
    std::vector<gpu::vec3> yields;      // [lights.size()] as package::lightPower() takes them; empty: all 1
    uint32_t emissive_triangles = 0;
    float total_power = 0; // W, luminance
};

/// Powers, probabilities and aliases are those of package::LightTable. Lights without power are left out, but for those that
/// animations may light: what moves, and triangles whose material's emission is animated.
LightTables buildLights(const SceneData& scene);
