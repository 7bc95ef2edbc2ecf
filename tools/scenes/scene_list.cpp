#include "tools/scenes/scenes.h"

namespace
{

constexpr Scene kScenes[] = {
    {"cornell", cornellScene, "a Cornell box of 1 m with a lamp in its ceiling"},
    {"caustics", causticsScene, "a glass sphere and a gold ring under a small lamp"},
    {"materials", materialsScene, "spheres with coats, sheen, grain, a thin film, dispersion and translucence"},
    {"atrium", atriumScene, "a two-storey hall in the sun, with lanterns, metal and glass"},
    {"sheets", [] { return sheetsScene(); }, "a room of single sheets, the sun on their outside"},
    {"small", [] { return sheetsScene(1e-3); }, "the same a thousandth as large"},
    {"large", [] { return sheetsScene(1e3); }, "the same a thousand times as large"},
    {"slot", slotScene, "a hall of single sheets, sun through a slot in its roof"},
    {"bright80", [] { return brightScene(0.8f); }, "a closed room of albedo 0.8 with a small lamp"},
    {"bright90", [] { return brightScene(0.9f); }, "the same of albedo 0.9"},
    {"bright95", [] { return brightScene(0.95f); }, "the same of albedo 0.95"},
    {"neighbours", [] { return neighboursScene(true); }, "a dim room, one sheet from a room 400 times as bright"},
    {"neighbours_alone", [] { return neighboursScene(false); }, "the same, the other room dark"},
    {"plain0", [] { return plainScene(0); }, "a room of 4 m with a window in the sun"},
    {"plain1", [] { return plainScene(1000); }, "the same on a ground plane of 1 km"},
    {"plain10", [] { return plainScene(10000); }, "the same on a ground plane of 10 km"},
    {"far", [] { return farScene(true); }, "a court with punctual lights at map coordinates"},
    {"far_local", [] { return farScene(false); }, "the same at the origin"},
    {"decal", [] { return decalScene(true); }, "a cut-out decal in the plane of a wall of its colour"},
    {"decal_none", [] { return decalScene(false); }, "the same without the decal"},
    {"terminator", [] { return terminatorScene(false); }, "smooth balls of few polygons in a low sun"},
    {"terminator_fine", [] { return terminatorScene(true); }, "the same of many polygons"},
    {"flipped", [] { return flippedScene(true); }, "normals against the winding of the triangles"},
    {"flipped_agreed", [] { return flippedScene(false); }, "the same with the winding"},
    {"door", doorScene, "a door that opens on a dark room"},
    {"lamp", lampScene, "a lamp that is carried through a room"},
    {"walker", walkerScene, "a skinned figure that walks"},
    {"ball", ballScene, "a mirror ball that rolls through a caustic"},
    {"shield", [] { return shieldScene(true); }, "a lamp 2 mm over an opaque shield, 30 m over the floor"},
    {"shield_unlit", [] { return shieldScene(false); }, "the same without the lamp"},
};

} // namespace

std::span<const Scene> allScenes()
{
    return kScenes;
}
