// Where in a package's arrays lies what moves: always at the end.
#pragma once
#include <cstdint>
#include <vector>

namespace package
{
/// What one object of MOTN has in the package's arrays: a range of each.
struct MovingRange
{
    uint32_t root_node; // of its part of the hierarchy, whose nodes follow each other: its children bound the object
    uint32_t node_count;
    uint32_t first_slot; // into the leaf triangles, of which it has triangle_count: each triangle is in one leaf
    uint32_t first_triangle;
    uint32_t triangle_count;
    uint32_t first_vertex; // into the vertices, those that stand still counted; its triangles have no others
    uint32_t vertex_count;
};

/// From these on everything moves, before them nothing does. The root is node 0 even where it has children of both kinds.
/// Where nothing moves, they are the sizes of the arrays.
struct MovingGeometry
{
    uint32_t first_node = 0;
    uint32_t first_slot = 0;
    uint32_t first_triangle = 0;
    uint32_t first_vertex = 0;
    std::vector<MovingRange> objects; // by Motion.objects
};
} // namespace package
