// The vertex attributes of one glTF primitive, from Draco where it has them, else from accessors.
#pragma once
#include "compiler/gltf_accessor.h"
#include "compiler/gltf_draco.h"

#include <string>

/// Borrows what it is made of.
class AttributeSource
{
public:
    static constexpr size_t kAnyCount = ~size_t(0);

    /// @param draco null where the primitive is not compressed
    AttributeSource(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const DracoMesh* draco);

    bool has(const std::string& name) const;

    /// Empty where the primitive has no such attribute.
    /// @return kInvalid where it has other numbers of components or vertices, or is damaged
    Result<FloatArray> read(const std::string& name, uint32_t min_components, uint32_t max_components,
                            size_t vertex_count) const;

private:
    const tinygltf::Model& model_;
    const tinygltf::Primitive& primitive_;
    const DracoMesh* draco_;
};
