// Walker's alias method: draws from a discrete distribution in constant time.
#pragma once
#include "format/gpu_scene.h"

#include <span>
#include <vector>

/// Vose's construction (1991) in double precision; equal weights in, equal table out.
/// @param weights not negative, not all 0. Entries of weight 0 are never drawn.
std::vector<gpu::AliasEntry> buildAliasTable(std::span<const double> weights);
