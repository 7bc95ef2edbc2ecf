// Opens .gltf and .glb files: reads every byte the scene refers to and hands back tinygltf's model of it.
#pragma once
#include "compiler/warnings.h"
#include "format/result.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

/// Where an image of the file lies; it is read only if a material in use needs it.
struct GltfImage
{
    std::string name;     // for messages: the file's name for it, its URI or its number
    std::string uri;      // empty: in a buffer view
    int buffer_view = -1; // unchecked
};

struct GltfFile
{
    std::filesystem::path folder;      // relative URIs start here
    tinygltf::Model model;             // buffers loaded; indices between its parts as after repairGltf(); no images
    std::vector<GltfImage> images;     // as in the file
    Warnings warnings;
};

/// Damaged items are replaced and reported (gltf_repair.h); a buffer that cannot be read is too, and is one byte long then.
/// @return kIo where the file cannot be read, kInvalid where it is not glTF 2, kUnsupported for another glTF version, an unknown required extension or one that cannot be decoded
Result<GltfFile> readGltf(const std::filesystem::path& path);

/// The bytes behind a `uri` of the file: base64 data or a file in `folder`.
Result<std::vector<unsigned char>> readUri(const std::string& uri, const std::filesystem::path& folder);

/// `message` with paths below `folder` relative to it, so that what is kept does not depend on where the scene lies.
std::string withoutFolder(std::string message, const std::filesystem::path& folder);

/// A whole regular file, or kIo with the system's reason.
Result<std::vector<unsigned char>> readFile(const std::filesystem::path& path);

/// The bytes of a buffer view, or kInvalid where it is out of range. Borrowed from the model.
struct ByteView
{
    const unsigned char* data = nullptr;
    size_t bytes = 0;
    size_t stride = 0; // 0: tightly packed
};
Result<ByteView> viewBytes(const tinygltf::Model& model, int buffer_view);
