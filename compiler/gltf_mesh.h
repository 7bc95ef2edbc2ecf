// Reads one glTF primitive into triangles.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/mesh.h"

/// @return nothing where the primitive has no surface (points, lines, no position); kInvalid where its data is damaged.
///         `material` is left at 0.
Result<std::optional<MeshPrimitive>> readPrimitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive);
