// Which vertices, triangles, leaves and nodes move: the last ones, or there is an error.
#include "format/package_verify.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace package
{
namespace
{
/// Leaf slots below a node, or of an object.
struct Slots
{
    uint32_t first = std::numeric_limits<uint32_t>::max();
    uint32_t end = 0;

    void grow(const Slots& other)
    {
        first = std::min(first, other.first);
        end = std::max(end, other.end);
    }
    bool isEmpty() const { return first >= end; }
};

/// In the order of a walk, so that what is below a node follows it, and its slots follow each other.
std::vector<Slots> slotsOfNodes(std::span<const gpu::BvhNode> nodes)
{
    std::vector<Slots> slots(nodes.size());
    for (size_t i = nodes.size(); i-- > 0;)
        for (const uint32_t child : {nodes[i].child.x, nodes[i].child.y, nodes[i].child.z, nodes[i].child.w})
        {
            if (child == gpu::kNone)
                continue;
            const uint32_t first = child & gpu::kLeafFirstMask;
            slots[i].grow((child & gpu::kLeafBit) == 0
                              ? slots[child]
                              : Slots{first, first + (child >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1});
        }
    return slots;
}

class MovingFinder
{
public:
    MovingFinder(const Contents& contents, MovingGeometry& moving) : contents_(contents), moving_(moving) {}

    Status run()
    {
        const auto& objects = *contents_.motion->objects();
        moving_.first_triangle = objects.Get(0)->first_triangle();
        moving_.first_vertex = uint32_t(contents_.stored.positions.size() - contents_.moving_vertices.size());
        for (const lumicut::fb::MovingObject* object : objects)
            moving_.objects.push_back({.root_node = gpu::kNone,
                                       .node_count = 0,
                                       .first_slot = 0,
                                       .first_triangle = object->first_triangle(),
                                       .triangle_count = object->triangle_count(),
                                       .first_vertex = 0,
                                       .vertex_count = 0});
        for (const auto part : {&MovingFinder::vertices, &MovingFinder::slots, &MovingFinder::nodes})
            if (Status status = (this->*part)(); !status)
                return status;
        return Success{};
    }

private:
    Status vertices()
    {
        for (uint32_t i = 0; i < moving_.first_triangle; ++i)
        {
            const gpu::uvec3& t = contents_.stored.triangles[i].vertices;
            if (std::max({t.x, t.y, t.z}) >= moving_.first_vertex)
                return invalid("chunk TRIS: triangle {} stands still but has a vertex that moves", i);
        }
        uint32_t next = moving_.first_vertex;
        for (MovingRange& object : moving_.objects)
        {
            object.first_vertex = next;
            for (uint32_t i = object.first_triangle; i < object.first_triangle + object.triangle_count; ++i)
            {
                const gpu::uvec3& t = contents_.stored.triangles[i].vertices;
                if (std::min({t.x, t.y, t.z}) < object.first_vertex)
                    return invalid("chunk TRIS: triangle {} moves but has a vertex that stands still, or one of "
                                   "another object",
                                   i);
                next = std::max(next, std::max({t.x, t.y, t.z}) + 1);
            }
            object.vertex_count = next - object.first_vertex;
        }
        if (next != contents_.stored.positions.size())
            return invalid("chunk MVTX: no triangle has vertex {}", next);
        return Success{};
    }

    Status slots()
    {
        const std::span<const uint32_t> leaves = contents_.stored.leaf_triangles;
        const size_t moving_count = contents_.stored.triangles.size() - moving_.first_triangle;
        if (leaves.size() < moving_count)
            return invalid("chunk LEAF: {} entries for {} triangles that move", leaves.size(), moving_count);
        moving_.first_slot = uint32_t(leaves.size() - moving_count);
        std::vector<uint32_t> object_of(moving_count);
        for (uint32_t o = 0; o < moving_.objects.size(); ++o)
            std::fill_n(object_of.begin() + (moving_.objects[o].first_triangle - moving_.first_triangle),
                        moving_.objects[o].triangle_count, o);
        std::vector<bool> seen(moving_count);
        object_slots_.resize(moving_.objects.size());
        for (uint32_t i = 0; i < leaves.size(); ++i)
        {
            const bool moves = leaves[i] >= moving_.first_triangle;
            const uint32_t number = leaves[i] - moving_.first_triangle;
            if (moves != (i >= moving_.first_slot) || (moves && seen[number]))
                return invalid("chunk LEAF: entry {} is triangle {}; those that move come last, each once", i,
                               leaves[i]);
            if (!moves)
                continue;
            seen[number] = true;
            object_slots_[object_of[number]].grow({i, i + 1});
        }
        return Success{};
    }

    Status nodes()
    {
        std::unordered_map<uint32_t, uint32_t> object_at; // by first slot
        for (uint32_t o = 0; o < moving_.objects.size(); ++o)
        {
            moving_.objects[o].first_slot = object_slots_[o].first;
            object_at[object_slots_[o].first] = o;
        }
        const std::vector<Slots> below = slotsOfNodes(contents_.bvh_nodes);
        moving_.first_node = moving_.first_slot == 0 ? 0 : uint32_t(below.size());
        for (uint32_t i = 0; i < below.size(); ++i)
        {
            if (below[i].isEmpty())
                return invalid("chunk NODE: node {} holds no triangles", i);
            if (i > 0 && below[i].first < moving_.first_slot && below[i].end > moving_.first_slot)
                return invalid("chunk NODE: node {} holds triangles that move and others", i);
            if (below[i].first >= moving_.first_slot)
                moving_.first_node = std::min(moving_.first_node, i);
            const auto object = object_at.find(below[i].first);
            if (object == object_at.end() || below[i].end != object_slots_[object->second].end ||
                moving_.objects[object->second].root_node != gpu::kNone)
                continue;
            moving_.objects[object->second].root_node = i;
            const auto after =
                std::find_if(below.begin() + i, below.end(), [&](const Slots& s) { return s.first >= below[i].end; });
            moving_.objects[object->second].node_count = uint32_t(after - below.begin()) - i;
        }
        for (uint32_t o = 0; o < moving_.objects.size(); ++o)
            if (moving_.objects[o].root_node == gpu::kNone ||
                object_slots_[o].end - object_slots_[o].first != moving_.objects[o].triangle_count)
                return invalid("chunk NODE: no node holds object {} of chunk MOTN and nothing else", o);
        return Success{};
    }

    const Contents& contents_;
    MovingGeometry& moving_;
    std::vector<Slots> object_slots_; // by object
};
} // namespace

Status findMovingGeometry(const Contents& contents, MovingGeometry& moving)
{
    moving = {.first_node = uint32_t(contents.stored.nodes.size()),
              .first_slot = uint32_t(contents.stored.leaf_triangles.size()),
              .first_triangle = uint32_t(contents.stored.triangles.size()),
              .first_vertex = uint32_t(contents.stored.positions.size()),
              .objects = {}};
    if (contents.motion == nullptr || contents.motion->objects()->size() == 0)
        return Success{};
    if (contents.moving_vertices.size() > contents.stored.positions.size())
        return invalid("chunk MVTX: {} vertices, chunk VPOS has {}", contents.moving_vertices.size(),
                       contents.stored.positions.size());
    return MovingFinder(contents, moving).run();
}
} // namespace package
