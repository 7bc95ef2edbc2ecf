// The rough reflection lobe as a few numbers: what reflection by spherical harmonics needs to know of it.
#pragma once
#include "shaders/gather/harmonics.h"

#include <vector>

/// The GGX lobe (glTF 2.0, appendix B) of a roughness, seen at `cosine` from the normal; by numeric integration.
/// Its direction is the mean of the BRDF without its Fresnel factor and without the cosine, which the light brings along; its
/// zonal coefficients are that function's, averaged around the direction: of all zonal functions of so few bands the closest.
/// @param roughness >= 0.1 (sharper ones would need a finer grid), @param cosine 0 to 1
gpu::GlossyLobe glossyLobe(double roughness, double cosine);

/// gpu::GlossyLobe[kLobeRoughnesses][kLobeCosines], cosines fastest.
std::vector<gpu::GlossyLobe> glossyLobes();
