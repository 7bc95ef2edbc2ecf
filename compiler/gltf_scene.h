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
    std::vector<std::string> warnings; // full sentences
};

/// @return kInvalid for indices out of range, a node reached twice (a cycle or two parents), damaged matrices or
///         numbers that are not finite
Result<SceneNodes> walkScene(const tinygltf::Model& model);
