// glTF in, scene out: everything that the file says, in object space and with images still encoded.
#pragma once
#include "compiler/gltf_scene.h"
#include "compiler/images.h"
#include "compiler/mesh.h"

#include <vector>

struct ImportedInstance
{
    size_t first_primitive = 0; // into ImportedScene::primitives
    size_t primitive_count = 0;
    Transform to_world;
};

struct ImportedScene
{
    SceneData scene;                         // without mesh and images
    std::vector<MeshPrimitive> primitives;   // complete with normals; with tangents where a normal map needs them
    std::vector<ImportedInstance> instances; // one object each
    std::vector<ImageRequest> images;        // what SceneData::images is to hold
};

/// What to take of a file that holds more than one thing.
struct ImportChoice
{
    std::string scene;   // name or index; empty: the file's default
    std::string variant; // of KHR_materials_variants; empty: the materials that primitives name themselves
};

/// Reads geometry, materials, lights and cameras of one scene of the file, in the pose that it shows at rest.
/// @return kUsage listing what there is where a choice names nothing
Result<ImportedScene> importScene(const GltfFile& file, const ImportChoice& choice = {});
