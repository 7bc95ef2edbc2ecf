// Morph targets of glTF primitives.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/mesh.h"

#include <span>
#include <vector>

/// Adds the displacements of the primitive's targets, each times its weight, to the attributes that `mesh` has. Targets
/// without a weight count 0 and are not read.
/// @return kInvalid where a target is damaged or has another number of vertices, or positions become infinite
Status applyMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                         std::span<const double> weights, MeshPrimitive& mesh);

/// The displacements of positions, normals and tangents of the primitive's first `count` targets, those that `mesh` has.
/// @return kInvalid where a target is damaged or has another number of vertices
Result<std::vector<MorphTarget>> readMorphTargets(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                                  size_t count, const MeshPrimitive& mesh);
