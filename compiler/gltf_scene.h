// Walks the node hierarchy of a glTF file's default scene.
#pragma once
#include "compiler/gltf_file.h"
#include "compiler/linear.h"
#include "compiler/scene_data.h"

#include <vector>

struct MeshInstance
{
    int mesh = 0; // index into the model's meshes, in range
    Transform to_world;
};

struct SceneNodes
{
    std::vector<MeshInstance> meshes; // in the order of the walk: parents first, siblings as listed
    std::vector<PunctualLight> lights;
    std::vector<CameraView> cameras;
    Warnings warnings;
};

/// What cannot be placed (a transform that is not finite, say) is left out with a warning.
/// @return kInvalid where there is no scene
Result<SceneNodes> walkScene(const tinygltf::Model& model);
