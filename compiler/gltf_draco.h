// Decodes KHR_draco_mesh_compression.
#pragma once
#include "compiler/gltf_accessor.h"

#include <map>
#include <optional>
#include <string>

struct DracoMesh
{
    size_t vertex_count = 0;
    std::vector<uint32_t> indices;                // 3 a triangle, all below vertex_count
    std::map<std::string, FloatArray> attributes; // by glTF semantic
};

/// Nothing where `primitive` is not compressed; kInvalid where the compressed data is damaged.
Result<std::optional<DracoMesh>> decodeDraco(const tinygltf::Model& model, const tinygltf::Primitive& primitive);
