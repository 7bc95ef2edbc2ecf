// KHR_materials_variants: other materials for the same meshes.
#pragma once
#include "compiler/gltf_file.h"

#include <string>
#include <vector>

/// Names of the file's variants, in its order.
std::vector<std::string> variantNames(const tinygltf::Model& model);

/// The index of the variant named `name`; -1, none, where `name` is empty. @return kUsage listing the variants
Result<int> findVariant(const tinygltf::Model& model, const std::string& name);

/// The material of a primitive in `variant` (-1: none); unchecked, -1: the default material.
int materialOf(const tinygltf::Primitive& primitive, int variant);
