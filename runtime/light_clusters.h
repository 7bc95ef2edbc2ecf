// Clusters of local lights: those that a surface mostly sees together. Direct light learns by cluster what is seen.
#pragma once
#include "format/gpu_scene.h"

#include <cstdint>
#include <span>
#include <vector>

/// The cluster of each light, below gpu::kMostClusters; 0 for directional and environment lights. Emissive triangles that share
/// corners are one object, a point or spot light is one of its own; where there are more objects than clusters, those that are
/// near each other share one.
std::vector<uint32_t> clusterLights(std::span<const gpu::Light> lights);
