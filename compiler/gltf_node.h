// Transforms of glTF nodes.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/linear.h"

#include <optional>
#include <span>
#include <vector>

bool isFiniteTransform(const Transform& transform);

/// A column-major 4 x 4 matrix whose last row is (0 0 0 w) but for rounding; nothing where it is projective.
std::optional<Transform> affineTransform(std::span<const double, 16> matrix);

/// A node's transform relative to its parent. @return kInvalid where its numbers are damaged
Result<Transform> localTransform(const tinygltf::Node& node, size_t index);

/// World transforms of nodes whether the scene shows them or not, as joints of skins may be anywhere.
class NodeTransforms
{
public:
    explicit NodeTransforms(const tinygltf::Model& model);

    /// @return kInvalid where there is no such node, it is its own ancestor, or a transform on the way is damaged
    Result<Transform> toWorld(int node);

private:
    static constexpr size_t kNoParent = ~size_t(0);

    const tinygltf::Model& model_;
    std::vector<size_t> parents_;                   // [node]
    std::vector<std::optional<Transform>> known_{}; // [node]
};
