// Reads glTF accessors of every kind (strided, normalised, sparse) into plain arrays, with every index checked.
#pragma once
#include "compiler/gltf_file.h"

#include <cstdint>
#include <vector>

struct FloatArray
{
    uint32_t components = 0;
    size_t count = 0;
    std::vector<float> values; // [count * components]
};

/// Reads an accessor as floats; normalised integers become [0, 1] or [-1, 1], others keep their value.
/// @param min_components, max_components what the caller can use; another type is kInvalid
Result<FloatArray> readFloats(const tinygltf::Model& model, int accessor, uint32_t min_components,
                              uint32_t max_components);

/// Reads a scalar accessor of unsigned integers, sparse or not.
Result<std::vector<uint32_t>> readIndices(const tinygltf::Model& model, int accessor);
