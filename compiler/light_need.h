// Whether a scene's own light shows it: the estimate behind the default sky and sun.
#pragma once
#include "compiler/build_bvh.h"
#include "compiler/build_lights.h"

#include <string>

struct LightNeed
{
    double radiance =
        0; // W/(m^2 sr), luminance: the lower bound of what the brightest quarter of the visible points reflects
    bool dark = false;    // the player's default display transform rounds that to black
    bool dim = false;     // ... shows it as 8 of 255 at most
    std::string sentence; // a full sentence if dark or dim is set
};

/// Traces a grid of rays from every camera (8 at most). At each visible point, irradiance is the sum of the lights'
/// unoccluded irradiance (local lights as if aimed at the point) and, for indirect light, the power of local lights (of
/// emissive surfaces as much as meets another surface) over a sphere with the scene's diagonal as radius. Surfaces reflect it
/// with an albedo of 0.5, and interreflection doubles that. If no ray hits anything, points on triangles all over the scene are
/// used. The estimate consists of ratios of areas and of powers to areas, so it does not depend on the scene's size.
/// @param lights as built from `scene`, which has at least one triangle
LightNeed judgeLight(const SceneData& scene, const Bvh& bvh, const LightTables& lights);
