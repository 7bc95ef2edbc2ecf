// Whether a scene's own light shows it: the estimate behind the default sky and sun.
#pragma once
#include "compiler/build_bvh.h"
#include "compiler/build_lights.h"

#include <string>

struct LightNeed
{
    double radiance = 0; // W/(m^2 sr), luminance: what the best lit quarter of the visible surfaces reflects at least
    bool dark = false;   // the player's default display transform rounds that to black
    bool dim = false;    // ... shows it as 8 of 255 at most
    std::string sentence; // full, where one of them is set
};

/// Looks from every camera (8 at most) through a grid of pixels. At each point that it sees, irradiance is the sum of what
/// every light would send if nothing were in the way (lamps as if aimed at the point), and, for light that comes by way of
/// other surfaces, the power of local lights over a sphere with the scene's diagonal as radius (of emissive surfaces as much as
/// meets another surface). Surfaces reflect it with an albedo of 0.5, and as much again between them. Where the cameras see nothing, triangles all over the scene count. It is
/// made of ratios of areas and of powers to areas, so the scene's size does not matter.
/// @param lights as built from `scene`, which has at least one triangle
LightNeed judgeLight(const SceneData& scene, const Bvh& bvh, const LightTables& lights);
