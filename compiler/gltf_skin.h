// Skins: which joints place a vertex, and where they place it.
#pragma once
#include "compiler/gltf_attributes.h"
#include "compiler/gltf_node.h"
#include "compiler/mesh.h"

#include <cstdint>
#include <vector>

/// Reads every set JOINTS_n, WEIGHTS_n. @return kInvalid where one is damaged or names a joint that is not there
Result<Influences> readInfluences(const AttributeSource& source, size_t vertex_count, size_t joint_count);

/// A skin in the pose of its joints' nodes.
struct SkinPose
{
    std::vector<Transform> joints; // [joint] from the mesh's space to the world: the node's transform times the inverse
                                   // bind matrix (glTF 2.0, 3.7.3.3)
    std::vector<Transform> binds;  // [joint] inverse bind matrices
    std::vector<size_t> nodes;     // [joint]
    Vec3d origin{};                // the first joint's place in the world
};

/// @return kInvalid where there is no such skin or its joints or matrices are damaged
Result<SkinPose> poseSkin(const GltfFile& file, int skin, NodeTransforms& nodes);

/// Moves a primitive to where its joints place it, relative to `pose.origin`; one without influences to where
/// `node_to_world` does. Where that mirrors it, winding and bitangents are mirrored with it.
/// @return of each vertex whether it is mirrored; kInvalid where positions become infinite
Result<std::vector<bool>> skinMesh(const SkinPose& pose, const Influences& influences, const Transform& node_to_world,
                                   MeshPrimitive& mesh);
