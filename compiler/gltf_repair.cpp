#include "compiler/gltf_repair.h"

#include "compiler/gltf_repair_items.h"

using nlohmann::json;

void repairGltf(json& document, Warnings& warnings)
{
    References references(document, warnings);
    references.repairLists();
    references.loseEach("bufferViews", [&](const JsonPlace& place) { return repairView(references, place); });
    references.loseEach("accessors", [&](const JsonPlace& place) { return repairAccessor(references, place); });
    references.each("images", [&](const JsonPlace& place, size_t) { repairImage(references, place); });
    references.each("samplers", [&](const JsonPlace& place, size_t) { repairSampler(place, warnings); });
    references.each("textures", [&](const JsonPlace& place, size_t) { repairTexture(references, place); });
    references.each("materials", [&](const JsonPlace& place, size_t) { repairMaterial(references, place); });
    references.each("meshes", [&](const JsonPlace& place, size_t) { repairMesh(references, place); });
    references.loseEach("cameras", [&](const JsonPlace& place) { return repairCamera(place, warnings); });
    references.loseEach(kLightList, [&](const JsonPlace& place) { return repairLight(place, warnings); });
    const json* nodes = references.list("nodes");
    NodeParents parents(nodes == nullptr ? 0 : nodes->size());
    references.each("nodes", [&](const JsonPlace& place, size_t i) { repairNode(references, place, i, parents); });
    breakCycles(references, parents);
    references.each("scenes", [&](const JsonPlace& place, size_t) { repairScene(references, place, parents); });
    references.resolve({document, ""}, "scene", "scenes", "scene", "the first scene counts");
}
