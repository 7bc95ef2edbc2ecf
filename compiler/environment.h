// Environment light: the default sky, a map's mean and its importance grid.
#pragma once
#include "compiler/scene_data.h"

/// The sky a scene without any light gets: smooth, blue above, grey-brown below. Stated in the report.
EnvironmentImage defaultSky();
/// The sun that goes with it.
PunctualLight defaultSun();

/// Mean over the sphere, W/(m^2 sr).
gpu::vec3 averageRadiance(const EnvironmentImage& image);

struct EnvironmentImportance
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<gpu::EnvironmentTexel> texels; // [width * height]
    gpu::vec3 average_radiance{};              // over the sphere
};

/// Importance proportional to filtered luminance x solid angle, on a grid of at most 1024 x 512.
EnvironmentImportance buildImportance(const EnvironmentImage& image);
