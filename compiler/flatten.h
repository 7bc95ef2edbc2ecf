// Transforms every object into one static triangle mesh in world space, without triangles that rays cannot hit.
#pragma once
#include "compiler/import_gltf.h"

/// Removes degenerate triangles (two corners in one place, no area) and repeats of a triangle (same corners, winding
/// and material), counts them, repairs normals without a direction, flips those of triangles whose three normals are
/// all behind their winding (vertices that are shared with other triangles are split), and drops vertices that nothing
/// uses. Objects that move come last, as at rest, and keep every triangle that has three corners; what moves their vertices
/// goes to imported.scene.motion. One that is hidden at rest has all its vertices in one place.
/// Primitives that a transform moves beyond the range of floats are left out with a warning.
/// @return kInvalid where nothing is left
Result<WorldMesh> flatten(ImportedScene& imported, ImportCounts& counts, Warnings& warnings);

struct Bounds
{
    gpu::vec3 min{};
    gpu::vec3 max{};
};

/// Of the vertices; the mesh is not empty.
Bounds bounds(const WorldMesh& mesh);
