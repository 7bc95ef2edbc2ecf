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
    uint32_t emissive_triangles = 0;
    float total_power = 0; // W, luminance
};

/// Power: point 4 pi I; spot over its cone; directional E pi R^2 and environment pi R^2 x radiance integrated over the
/// sphere, R the radius of the scene's bounding sphere; triangle pi A x mean emission (texture averaged over the
/// triangle), twice that where it emits on both sides. Lights without power are left out, but for those that move, which
/// are never picked at rest then. Lights are picked
/// in proportion to power; directional and environment lights beside local ones for at most half of all samples.
LightTables buildLights(const SceneData& scene);
