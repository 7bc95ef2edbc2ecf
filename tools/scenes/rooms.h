// The pieces that the plain rooms are made of.
#pragma once
#include "tools/scenes/gltf_writer.h"

MaterialDescription matte(const char* name, Vec3 albedo);

/// Emits `radiance`, W/(m^2 sr), to both sides and reflects nothing.
MaterialDescription glow(const char* name, Vec3 radiance);

/// What is left out of a parallelogram, as fractions of its edges.
struct Opening
{
    float u0, u1, v0, v1;
};

/// addQuad() with a rectangular opening: a frame of four, so that nothing overlaps.
void addQuadAround(Mesh& mesh, Vec3 p, Vec3 u, Vec3 v, Opening opening);

/// The inner faces of a box but for those at its greatest x (`right`) and greatest y (`top`), where these are false.
Mesh innerFaces(Vec3 low, Vec3 high, bool right = true, bool top = true);
