// Decodes the images of a glTF file: PNG, JPEG, WebP and KTX2 to RGBA8, or 16 bits where they have more than 8.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/scene_data.h"

#include <optional>
#include <span>
#include <vector>

/// One image of SceneData: which image of the file, and whether its colours are sRGB-encoded.
struct ImageRequest
{
    int source = 0; // index into GltfFile::images
    bool srgb = false;
    auto operator<=>(const ImageRequest&) const = default;
};

struct DecodedImage
{
    int source = 0;             // as requested
    TextureImage image;         // empty where there is an error
    std::optional<Error> error; // kInvalid: it does not decode, kIo: a missing file, kUnsupported: another format
};

/// Decodes on all cores. @return one image a request, in their order; kUnsupported where all together are too large
Result<std::vector<DecodedImage>> decodeImages(const GltfFile& file, std::span<const ImageRequest> requests);
