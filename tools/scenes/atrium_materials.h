// What the atrium is made of.
#pragma once
#include "tools/scenes/gltf_writer.h"

/// Indices of the materials in the file.
struct AtriumMaterials
{
    uint32_t tiles, brick, plaster, limestone, planks, cloth[3];
    uint32_t bronze, gold, mirror, glass, pane, water, marble, sky, lamp;
};

AtriumMaterials addAtriumMaterials(GltfWriter& gltf);
