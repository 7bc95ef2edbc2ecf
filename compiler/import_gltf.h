// Imports a glTF file as a scene, in object space and with images still encoded.
#pragma once
#include "compiler/gltf_scene.h"
#include "compiler/images.h"
#include "compiler/mesh.h"
#include "compiler/motion.h"

#include <optional>
#include <vector>

struct ImportedInstance
{
    size_t first_primitive = 0; // into ImportedScene::primitives
    size_t primitive_count = 0;
    Transform to_world;
    std::optional<MovingPlace> moving{}; // where animations move it
};

struct ImportedScene
{
    SceneData scene;                         // without mesh and images
    std::vector<MeshPrimitive> primitives;   // complete with normals; with tangents where a normal map needs them
    std::vector<ImportedInstance> instances; // one object each; those that move come last
    std::vector<ImageRequest> images;        // what SceneData::images is to hold
};

/// Selection from a file with several scenes or variants.
struct ImportChoice
{
    std::string scene;   // name or index; empty: the file's default
    std::string variant; // of KHR_materials_variants; empty: the materials that primitives name themselves
};

/// Reads geometry, materials, lights and cameras of one scene of the file, in the pose that it shows at rest, and what its
/// animations move.
/// @return kUsage with a list if a choice does not exist
Result<ImportedScene> importScene(const GltfFile& file, const ImportChoice& choice = {});
