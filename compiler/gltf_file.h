// Opens .gltf and .glb files: reads every byte the scene refers to and hands back tinygltf's model of it.
#pragma once
#include "compiler/gltf_document.h"
#include "compiler/gltf_uri.h"
#include "compiler/warnings.h"
#include "format/result.h"

#include <cstddef>
#include <filesystem>
#include <optional>
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

struct GltfSkin
{
    std::string name;
    std::vector<int> joints;                  // nodes, unchecked
    std::optional<int> inverse_bind_matrices; // accessor, unchecked; none: identities
};

/// One channel of an animation with its sampler, as in the file: indices unchecked, -1 where they are missing.
struct GltfChannel
{
    std::string path;    // "translation", ..., or "pointer" of KHR_animation_pointer
    int node = -1;       // that `path` is of
    std::string pointer; // what KHR_animation_pointer sets
    std::string interpolation = "LINEAR";
    int times = -1; // accessors
    int values = -1;
};

struct GltfAnimation
{
    std::string name;
    std::vector<GltfChannel> channels; // as in the file
};

struct GltfFile
{
    std::shared_ptr<InputFiles> files;     // relative URIs start in its folder; records all that were read
    tinygltf::Model model;                 // buffers loaded; indices between its parts as after repairGltf(); no images
                                           // skins and animations
    std::vector<GltfImage> images;         // as in the file
    std::vector<GltfSkin> skins;           // as in the file
    std::vector<GltfAnimation> animations; // as in the file
    Warnings warnings;
};

/// Damaged items are replaced and reported (gltf_repair.h); a buffer that cannot be read is too, and is one byte long then.
/// @return kIo where the file cannot be read, kInvalid where it is not glTF 2, kUnsupported for another glTF version, an unknown required extension or one that cannot be decoded
Result<GltfFile> readGltf(const std::filesystem::path& path);

/// The bytes of a buffer view, or kInvalid where it is out of range. Borrowed from the model.
Result<ByteView> viewBytes(const tinygltf::Model& model, int buffer_view);
