// Meshes of simple bodies: counter-clockwise seen from outside, with normals, and texture coordinates in metres.
#pragma once
#include "tools/scenes/vec.h"

#include <cstdint>
#include <functional>
#include <vector>

struct Mesh
{
    std::vector<Vec3> positions;   // metres
    std::vector<Vec3> normals;     // unit
    std::vector<Vec2> uvs;         // metres until scaleUvs()
    std::vector<uint32_t> indices; // 3 per triangle

    uint32_t addVertex(Vec3 position, Vec3 normal, Vec2 uv);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c);
    void add(const Mesh& part, const Placement& placement = {});
    void scaleUvs(float per_metre);
};

/// Parallelogram with corner `p` and edges `u`, `v`; it faces u x v. Texture u along `u`, measured from the corner.
void addQuad(Mesh& mesh, Vec3 p, Vec3 u, Vec3 v);

/// A grid of `columns` x `rows` cells; `point(s, t)` for s, t in 0..1. Faces d/ds x d/dt; normals from `point` itself.
/// `size`: the texture's extent in metres.
Mesh sheet(uint32_t columns, uint32_t rows, Vec2 size, const std::function<Vec3(float, float)>& point);

/// Box with its edges cut off at 45 degrees by `bevel` metres (0: sharp).
Mesh box(Vec3 low, Vec3 high, float bevel = 0);

/// Turns a profile of (radius, height) about +Y. A profile that rises faces outwards; corners above 35 degrees stay
/// sharp.
Mesh lathe(const std::vector<Vec2>& profile, uint32_t segments);

/// Sphere about the origin with smooth normals.
Mesh sphere(float radius, uint32_t segments, uint32_t rings);

/// A closed profile of (distance from the axis, height) points swept about +Y with smooth normals: a ring. The profile
/// runs counter-clockwise with distance to the right and height upwards.
Mesh ring(const std::vector<Vec2>& profile, uint32_t segments);

/// A fluted column shaft, open at both ends, from y = 0 to `height`, tapering from `radius` by an eighth.
Mesh flutedShaft(float radius, float height, uint32_t flutes);

/// The wall of one arcade bay above the springing line y = 0: x in +-width/2, up to `height`, with a half-round opening
/// of `radius`. Front at z = 0 facing +z, intrados back to z = -depth, a back face where `back`. Legs reach down to y =
/// -foot.
Mesh archBay(float width, float height, float radius, float depth, float foot, bool back, uint32_t segments);

/// A moulding of (distance from the centre, z) points along a half circle in the xy plane, ends at y = 0 open.
Mesh archMoulding(const std::vector<Vec2>& profile, uint32_t segments);
