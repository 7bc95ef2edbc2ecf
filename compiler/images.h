// Decodes the images of a glTF file: PNG, JPEG, WebP and KTX2 to RGBA8, or 16 bits where they have more than 8.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/scene_data.h"

#include <span>

/// One image of SceneData: which image of the file, and whether its colours are sRGB-encoded.
struct ImageRequest
{
    int source = 0; // index into GltfFile::images
    bool srgb = false;
    auto operator<=>(const ImageRequest&) const = default;
};

/// Decodes on all cores. @return one image a request, in their order; kInvalid naming the first that does not decode,
/// kIo for a missing file, kUnsupported for another format
Result<std::vector<TextureImage>> decodeImages(const GltfFile& file, std::span<const ImageRequest> requests);
