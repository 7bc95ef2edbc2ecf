// Parameters of the rough reflection lobe for reflection by spherical harmonics.
#pragma once
#include "shaders/gather/harmonics.h"

#include <vector>

/// The GGX lobe (glTF 2.0, appendix B) of a roughness, seen at `cosine` from the normal; by numeric integration.
/// Direction and concentration are those with which light times cosine times the zonal function has the mean direction that it
/// has with the BRDF (without its Fresnel factor): even light, and light that rises evenly along any axis, is then reflected
/// right. The sharper the lobe, the larger its error for light of higher bands.
/// @param roughness >= 0.1, @param cosine 0 to 1
gpu::GlossyLobe glossyLobe(double roughness, double cosine);

/// gpu::GlossyLobe[kLobeRoughnesses][kLobeCosines], cosines fastest.
std::vector<gpu::GlossyLobe> glossyLobes();
