// Whether a scene has mirrors, clear glass or smooth coats, which light follows without scattering. A scene without them needs no
// caustics and no chains of mirrors (gpu::kFeatureDeltaLobes).
#pragma once
#include "compiler/scene_data.h"

/// Part of a material's area that a texture may make smooth without anyone seeing that it is not: below it, its lobes are as wide as
/// kSmoothRoughness makes them. Many textures of roughness are black where no triangle shows them, and so a little at the seams: in
/// Sponza 0.00009 of what rays meet. A patch of 10 cm on a floor of 10 m by 10 m is as much as this.
inline constexpr double kLeastSmoothShare = 1e-4;

/// Part of all light, falling evenly on all surfaces, that delta lobes must send on to matter to other surfaces: as much as a caustic
/// of a hundredth of the light in a hundredth of the picture. Sponza, whose textures make 3 of 7700 square metres smooth, sends
/// 0.00002, which its caustic photons hardly ever find, and pays a tenth of the frame for them.
inline constexpr double kLeastSent = 1e-4;

struct DeltaLobes
{
    bool seen =
        false; // more than kLeastSmoothShare of some material's area, in the pose at rest, is below kSmoothRoughness
    bool matter = false; // they send more than kLeastSent
};

DeltaLobes findDeltaLobes(const SceneData& scene);
