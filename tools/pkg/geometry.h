// A package's triangles as a binary glTF file, to look at them elsewhere.
#pragma once
#include "format/package_read.h"

#include <cstdint>
#include <vector>

/// One mesh with a primitive per material: positions, normals, the first texture coordinates, and the materials' base
/// colours. In the package's frame; its origin and unit are the node's place.
std::vector<uint8_t> geometryGlb(const package::Package& package);
