// Reads one glTF primitive into triangles.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/gltf_skin.h"
#include "compiler/mesh.h"

#include <optional>
#include <span>
#include <string>

/// The properties that an imported primitive needs.
struct PrimitiveShape
{
    std::span<const double> morph_weights{}; // [target]; those that are missing are 0
    size_t joint_count = 0;                  // of the skin; 0: none, influences are not read
};

struct GltfPrimitive
{
    MeshPrimitive mesh;    // morphed; `material` is left at 0
    Influences influences; // empty where no joints move it
};

/// Damaged attributes but positions are left out, and triangles with corners that do not exist or are not finite, with a
/// warning about `pointer`, the primitive's place; so are damaged morph targets and joints.
/// @return nothing where the primitive has no surface (points, lines, no position); kInvalid where its positions or
///         indices cannot be read
Result<std::optional<GltfPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const PrimitiveShape& shape, const std::string& pointer,
                                                   Warnings& warnings);
