// Generates missing tangents by the MikkTSpace convention, for which normal maps are baked
// (M. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008; glTF 2.0, 3.7.2.1).
#pragma once
#include "compiler/mesh.h"

/// Handedness of the map's coordinates in triangle `t`, seen from the side where its corners run counter-clockwise: the
/// glTF tangent's w for a normal on that side. 0 where the coordinates have no area.
float handedness(const MeshPrimitive& mesh, gpu::uvec3 t, const TextureUse& map);

/// Makes tangents along the u direction of the map's coordinates. Corners of one position, normal and coordinates whose
/// triangles are joined by edges and have one handedness share theirs, the mean of their triangles' weighted by angle;
/// vertices between corners that do not are split. Needs normals. @return how many vertices have made tangents: all
uint64_t generateTangents(MeshPrimitive& mesh, const TextureUse& map);
