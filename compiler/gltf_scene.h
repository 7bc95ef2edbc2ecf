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
};

struct SceneNodes
{
    std::vector<MeshInstance> meshes; // in the order of the walk: parents first, siblings as listed
    std::vector<PunctualLight> lights;
    std::vector<CameraView> cameras;
    Warnings warnings;
};

/// Items that cannot be placed (with a transform that is not finite, for example) are left out with a warning.
/// @return kInvalid where there is no scene, kUsage listing the scenes where none is named `scene`
/// @param scene name or index; empty: the file's default
Result<SceneNodes> walkScene(const tinygltf::Model& model, const std::string& scene = "");
