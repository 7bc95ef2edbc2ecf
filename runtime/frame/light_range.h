// By how much a pixel's light may differ from the last frame's: light is linear in what lights emit.
#pragma once
#include "format/gpu_scene.h"

#include <optional>
#include <span>
#include <vector>

/// Every pixel's light is that of the frame before times a factor from `least` to `most`, by channel, >= 0.
struct LightRange
{
    gpu::vec3 least, most;

    /// Where lights or geometry have moved: nothing is known.
    static LightRange anything();
    /// The factor within that is nearest to 1: so much change is sure.
    gpu::vec3 surely() const;
    /// All pixels' light has changed alike, so that surely() is exact.
    bool isOneFactor() const;
    bool operator==(const LightRange& other) const;
};

/// What emits light in a scene.
struct Emitters
{
    std::vector<gpu::Light> lights;
    std::vector<gpu::vec3> emissions; // by material
};

/// Of the light that `now` gives; a light that only emits more or less bounds it. Both have the same lights and materials.
LightRange lightRange(const Emitters& before, const Emitters& now);
