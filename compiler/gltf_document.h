// A glTF file's JSON and binary chunk, uninterpreted.
#pragma once
#include "format/result.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <vector>

/// Bytes in a row, perhaps with a stride between elements. Borrowed.
struct ByteView
{
    const unsigned char* data = nullptr;
    size_t bytes = 0;
    size_t stride = 0; // 0: tightly packed
};

struct GltfDocument
{
    nlohmann::json json;         // an object of glTF 2, what is in it unchecked: repairGltf()
    std::optional<ByteView> bin; // the BIN chunk of a binary glTF, borrowed from the file's bytes
};

/// Splits a .gltf or .glb file into its parts. @return kInvalid if it is no glTF, kUnsupported for another version of it
Result<GltfDocument> parseDocument(const std::vector<unsigned char>& bytes);
