// Repairs of single items, a file for each kind of them; gltf_repair.cpp calls them in order.
#pragma once
#include "compiler/gltf_references.h"

/// gltf_repair_data.cpp: @return false where an item cannot be used
bool repairView(References& references, const JsonPlace& view);
bool repairAccessor(References& references, const JsonPlace& accessor);

/// gltf_repair_material.cpp. An image's bytes are read where a material needs them.
void repairImage(References& references, const JsonPlace& image);
void repairTexture(References& references, const JsonPlace& texture);
void repairMaterial(References& references, const JsonPlace& material);

/// gltf_repair_mesh.cpp: a primitive that cannot be drawn has no attributes afterwards.
void repairMesh(References& references, const JsonPlace& mesh);

/// gltf_repair_node.cpp. Every node has one parent at most and is not its own ancestor, and no root has any parent.
using NodeParents = std::vector<std::optional<size_t>>; // of each node
void repairNode(References& references, const JsonPlace& node, size_t number, NodeParents& parents);
void breakCycles(References& references, NodeParents& parents); // once all nodes are repaired
void repairScene(References& references, const JsonPlace& scene, const NodeParents& parents);
