// The moving vertices of a package in a pose, computed as the player does, but in double precision.
#pragma once
#include "format/package_read.h"
#include "format/pose.h"
#include "format/vec3d.h"

#include <array>
#include <vector>

using Corners = std::array<Vec3d, 3>;

/// Where the last vertices lie, in the package's units of length.
std::vector<Vec3d> movedVertices(const package::Package& package, const package::Pose& pose);

/// By vertex, as the package has them at rest. Vertices without a triangle are 0.
std::vector<Vec3d> restVertices(const package::Package& package);

/// Triangles over `positions` of the vertices, in the source's metres.
std::vector<Corners> trianglesOver(const package::Package& package, const std::vector<Vec3d>& positions);

/// The largest distance of a corner from that of the triangle of the other list that is most like it, whichever list it is
/// in, however corners are rotated. Triangles without an area do not count.
double farthestCorner(const std::vector<Corners>& a, const std::vector<Corners>& b);
