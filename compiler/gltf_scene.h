// Walks the node hierarchy of a scene of a glTF file.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/linear.h"
#include "compiler/scene_data.h"

#include <vector>

struct MeshInstance
{
    int mesh = 0;                      // index into the model's meshes, in range
    Transform to_world;                // of the node
    int skin = -1;                     // -1: none, and `to_world` places it; else its joints do. Unchecked
    std::vector<double> morph_weights; // [target]; those that are missing are 0
    size_t node = 0;                   // of the file
    Transform instance;                // of EXT_mesh_gpu_instancing, relative to the node
    bool hidden = false;               // it is among the nodes that may be shown
};

struct SceneNodes
{
    std::vector<MeshInstance> meshes;  // in the order of the walk: parents first, siblings as listed
    std::vector<PunctualLight> lights; // dark while hidden
    std::vector<size_t> light_nodes;   // [light]
    std::vector<CameraView> cameras;
    std::vector<size_t> camera_nodes; // [camera]
    Warnings warnings;
};

/// The light that a node of a repaired model carries, -1: none.
int lightOf(const tinygltf::Node& node);

/// Items that cannot be placed (with a transform that is not finite, for example) are left out with a warning.
/// @return kInvalid where there is no scene, kUsage listing the scenes where none is named `scene`
/// @param scene name or index; empty: the file's default
/// @param may_show [node] whether an animation may show a node that is hidden at rest; empty: none
Result<SceneNodes> walkScene(const tinygltf::Model& model, const std::string& scene = "",
                             const std::vector<bool>& may_show = {});
