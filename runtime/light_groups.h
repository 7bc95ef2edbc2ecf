// Lights grouped into directional, environment and local ones, each group with an alias table: direct light samples every group.
#pragma once
#include "shaders/direct/direct.h"

#include <span>
#include <vector>

enum class LightKind
{
    kDirectional,
    kEnvironment, // like a directional light, its power does not tell how much of it is visible
    kLocal,
};

struct LightGroup
{
    LightKind kind;
    uint32_t first_pick; // its part of LightGroups::picks
    uint32_t pick_count; // lights
    float share;         // fraction of all lights' pmf, > 0
    bool one_place;      // a single punctual light: each sample of it is the same
};

struct LightGroups
{
    std::vector<LightGroup> groups; // that have a light: none to three
    std::vector<gpu::LightPick> picks;
};

/// Within a group, lights are picked in proportion to their pmf. Lights of pmf 0 are in no group.
LightGroups groupLights(std::span<const gpu::Light> lights);

/// Directional or environment: its power does not tell how much of it is visible. Otherwise it is a local light.
LightKind lightKind(const gpu::Light& light);
/// It comes from one place or direction.
bool isPunctual(const gpu::Light& light);
