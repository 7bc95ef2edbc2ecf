// Opens .gltf and .glb files: reads every byte the scene refers to and hands back tinygltf's model of it.
#pragma once
#include "compiler/input_files.h"
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
    std::shared_ptr<InputFiles> files; // relative URIs start in its folder; knows all that were read
    tinygltf::Model model;             // buffers loaded; indices between its parts are unchecked; no images
    std::vector<GltfImage> images;     // as in the file
    std::vector<std::string> warnings; // full sentences
};

/// @return kIo where the file cannot be read, kInvalid where it is not glTF 2 or one of its buffers is missing,
///         kUnsupported for another glTF version, an unknown required extension or one that cannot be decoded
Result<GltfFile> readGltf(const std::filesystem::path& path);

/// The bytes behind a `uri` of the file: base64 data or one of `files`.
Result<std::vector<unsigned char>> readUri(const std::string& uri, InputFiles& files);

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
