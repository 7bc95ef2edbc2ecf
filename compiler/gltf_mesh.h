// Reads one glTF primitive into triangles.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/gltf_skin.h"
#include "compiler/mesh.h"

#include <optional>
#include <span>

/// The shape in which a primitive is wanted.
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

/// @return nothing where the primitive has no surface (points, lines, no position); kInvalid where its data is damaged
Result<std::optional<GltfPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const PrimitiveShape& shape = {});
