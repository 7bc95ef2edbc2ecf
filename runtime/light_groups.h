// Lights grouped into directional, environment and local ones, each group with clusters that have alias tables: direct light samples
// every group.
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
    uint32_t first_cluster; // its part of LightGroups::clusters
    uint32_t cluster_count; // 1, but for local lights
    bool punctual;          // every cluster is one punctual light: each sample of it is the same
    bool one_place;         // and there is one cluster
    uint32_t extended;      // bit i: cluster i, of kMostClusters at most, has lights with an area
};

struct LightGroups
{
    std::vector<LightGroup> groups; // that have a light: none to three
    std::vector<gpu::LightCluster> clusters;
    std::vector<gpu::LightPick> picks;
    std::vector<float> densities; // of choosing a light in its cluster, over its pmf; 0 for lights of pmf 0
};

/// Within a cluster, lights are picked in proportion to their pmf. Lights of pmf 0 are in none.
/// @param clusters of local lights, by light
LightGroups groupLights(std::span<const gpu::Light> lights, std::span<const uint32_t> clusters);

/// Directional or environment: its power does not tell how much of it is visible. Otherwise it is a local light.
LightKind lightKind(const gpu::Light& light);
/// It comes from one place or direction.
bool isPunctual(const gpu::Light& light);
