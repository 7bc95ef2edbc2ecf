// Reads one glTF primitive into triangles.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/mesh.h"

/// Damaged attributes but positions are left out, and triangles with corners that do not exist or are not finite, with a
/// warning about `pointer`, the primitive's place.
/// @return nothing where the primitive has no surface (points, lines, no position); kInvalid where its positions or
///         indices cannot be read. `material` is left at 0.
Result<std::optional<MeshPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                   const std::string& pointer, Warnings& warnings);
