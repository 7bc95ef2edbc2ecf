// Turns glTF materials and their KHR_materials_* extensions into the package's.
#pragma once
#include "compiler/images.h"

/// Appends to `scene` the materials of the file that `used` names, in that order (-1: glTF's default material), their
/// texture uses, and to `requests` the images these need (TextureUse::image indexes `requests`).
void importMaterials(const GltfFile& file, std::span<const int> used, SceneData& scene,
                     std::vector<ImageRequest>& requests);

/// Sets the scene's images, [request_count] as decoded. Textures without one are removed from materials, with a warning that
/// names the replacement: the factor; for normal maps the surface's normals; for emissive textures no emission.
void takeImages(std::vector<DecodedImage> decoded, SceneData& scene);

/// The texture along whose coordinates a material's tangents lie, an index into SceneData::texture_uses: gpu::kNone where it
/// has none (an anisotropic material without textures then takes TEXCOORD_0).
uint32_t tangentTexture(const gpu::Material& material);

/// gpu::kTriangle* bits of each material: alpha only where coverage can be below 1. Needs decoded images.
std::vector<uint32_t> materialTriangleFlags(const SceneData& scene);
