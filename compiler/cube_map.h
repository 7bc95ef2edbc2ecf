// Cube maps as OpenEXR stores them, to equirectangular ones.
#pragma once
#include "compiler/scene_data.h"

/// @param cube six square faces below each other, +X, -X, +Y, -Y, +Z, -Z, oriented as OpenEXR's ImfEnvmap.h says
/// @return a map of four face sides by two, within kMaxEnvironmentWidth: each texel the mean of 2 x 2 bilinear lookups
EnvironmentImage toEquirectangular(const EnvironmentImage& cube);
