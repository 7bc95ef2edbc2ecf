// The demo scenes, each built from nothing into a binary glTF file. All CC0.
#pragma once
#include "tools/scenes/gltf_writer.h"

#include <string_view>

/// A Cornell box of 1 m: Lambertian walls, two boxes, one lamp flush in the ceiling.
GltfWriter cornellScene();

/// A table with a glass sphere and a gold ring under a small bright lamp.
GltfWriter causticsScene();

/// A two-storey hall with colonnades, banners, sun through a skylight, lanterns, a mirror, metal and glass.
GltfWriter atriumScene();
