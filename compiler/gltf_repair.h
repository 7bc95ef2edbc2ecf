// Replaces what is damaged in a glTF file's JSON, item by item, before anything else reads it.
#pragma once
#include "compiler/warnings.h"

#include <nlohmann/json.hpp>

/// Every damaged item is replaced by a harmless one, with a warning: defect, place and replacement:
/// indices that name nothing go, numbers out of range become allowed ones, properties of a wrong type get their
/// default; primitives, cameras and lights that cannot be understood go with every reference to them. Items keep their
/// numbers. Afterwards all top-level lists are arrays of objects; indices between nodes, meshes, primitives, materials,
/// textures, samplers, images, accessors, buffer views, buffers, cameras and lights are in range; every node has one
/// parent at most and no scene's root has any. Bytes of buffers are not looked at.
void repairGltf(nlohmann::json& document, Warnings& warnings);
