// Turns glTF materials and their KHR_materials_* extensions into the package's.
#pragma once
#include "compiler/images.h"

/// Appends to `scene` the materials of the file that `used` names, in that order (-1: glTF's default material), their
/// texture uses, and to `requests` the images these need (TextureUse::image indexes `requests`).
Status importMaterials(const GltfFile& file, std::span<const int> used, SceneData& scene,
                       std::vector<ImageRequest>& requests);

/// gpu::kTriangle* bits of each material: alpha only where coverage can be below 1. Needs decoded images.
std::vector<uint32_t> materialTriangleFlags(const SceneData& scene);
