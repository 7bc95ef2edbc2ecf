// The scenes, each built from nothing into a binary glTF file. All CC0.
#pragma once
#include "tools/scenes/gltf_writer.h"

#include <span>

struct Scene
{
    const char* name;
    GltfWriter (*build)();
    const char* about; // one clause, for lists
};

/// Every scene, in the order in which they are listed and written.
std::span<const Scene> allScenes();

/// A Cornell box of 1 m: Lambertian walls, two boxes, one lamp flush in the ceiling.
GltfWriter cornellScene();

/// A table with a glass sphere and a gold ring under a small bright lamp.
GltfWriter causticsScene();

/// A row of spheres, each with a layer that an extension of glTF adds.
GltfWriter materialsScene();

/// A two-storey hall with colonnades, banners, sun through a skylight, lanterns, a mirror, metal and glass.
GltfWriter atriumScene();

/// A room of single sheets with a window; the sun lights their outside. Metres times `scale`.
GltfWriter sheetsScene(double scale = 1);

/// A hall of single sheets with a narrow slot in its roof: all of the light has come through it.
GltfWriter slotScene();

/// Two closed rooms that share one sheet, the camera in the dim one; the other has a lamp 400 times as bright, or none.
GltfWriter neighboursScene(bool bright_lamp);

/// A closed room of one albedo with a small lamp: many interreflections.
GltfWriter brightScene(float albedo);

/// A room with thick walls and a window in the sun, on a ground plane of `ground` metres side (0: none).
GltfWriter plainScene(float ground);

/// A court with a point and a spot light, all of it placed by one node: at the origin or at map coordinates.
GltfWriter farScene(bool at_map_coordinates);

/// A wall and, before it in the file and in the very same plane, a cut-out decal of the same colour, or none.
GltfWriter decalScene(bool decal);

/// Smooth balls of few polygons, or of many, in the light of a low sun.
GltfWriter terminatorScene(bool fine);

/// A corner with a box and a ball, normals against the winding of the triangles or with it.
GltfWriter flippedScene(bool against);

/// A floor in dim sun; 30 m above it, with or without, a lamp 2 mm over an opaque shield that hides it from the floor.
GltfWriter shieldScene(bool lamp);

/// A dark room and a bright hall behind a door, which opens within two seconds.
GltfWriter doorScene();

/// A lamp, a point light over a small glowing ball, that is carried around a room.
GltfWriter lampScene();

/// A figure of one skinned mesh that walks through a room.
GltfWriter walkerScene();

/// A mirror ball that rolls through the caustic of a glass ball under a small lamp.
GltfWriter ballScene();

/// `count` boxes that travel and turn over a ground. Not among allScenes().
GltfWriter boxesScene(uint32_t count);

/// `count` boxes that change places, within four seconds. Not among allScenes().
GltfWriter swarmScene(uint32_t count);

/// A tube of about `triangles` triangles that 32 joints bend. Not among allScenes().
GltfWriter tubeScene(uint32_t triangles);

/// About `triangles` triangles, at least 1000: rolling ground with boulders. Not among allScenes().
GltfWriter terrainScene(uint32_t triangles);
