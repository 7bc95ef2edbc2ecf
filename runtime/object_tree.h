// The tree above the objects that move. Refitting keeps an object's own tree good, but not this one: objects that travel make its
// boxes overlap. Its shape stays that of the package (nodes, how many objects are below each, and so the traversal stack's
// need); what changes is which object hangs where.
#pragma once
#include "format/gpu_scene.h"
#include "format/moving_range.h"
#include "shaders/pose/pose.h"

#include <array>
#include <limits>
#include <span>
#include <vector>

struct ObjectBox // metres; low > high where there is nothing to be seen
{
    static constexpr float kMost = std::numeric_limits<float>::max();
    std::array<float, 3> low{kMost, kMost, kMost}, high{-kMost, -kMost, -kMost};

    bool isEmpty() const { return low[0] > high[0]; }
    void grow(const ObjectBox& other);
    double halfArea() const; // square metres; 0 where it is empty
};

class ObjectTree
{
public:
    /// Objects hang anew once the sum of their boxes' areas and those above them has changed by this factor.
    static constexpr double kDrift = 1.25;

    /// Objects hang as in the package. @param first_moving_node objects as Package has them
    ObjectTree(std::span<const gpu::BvhNode> nodes, uint32_t first_moving_node,
               std::span<const package::MovingRange> objects, double drift = kDrift);

    /// Whether another order of objects can make a difference, and no order asks for more than the traversal stack has.
    bool canChange() const { return can_change_; }
    /// Hangs objects anew where the tree has become worse, or may have: half to either side along the longest axis, as the
    /// compiler does. Allocates nothing. @param boxes by object, finite where not empty
    /// @return by place, in the order of a walk: where each object hangs now; empty where all hang as before
    std::span<const gpu::PosedObject> update(std::span<const ObjectBox> boxes);
    /// Half the area of all boxes that hang in the tree, those of objects included: what rays pay on their way down to objects.
    double cost(std::span<const ObjectBox> boxes);

private:
    struct Child
    {
        uint32_t link;  // where it hangs, as in shaders/pose/pose.h
        uint32_t node;  // into nodes_, or gpu::kNone: an object's place
        uint32_t count; // objects below
    };
    struct Node // its children follow each other in children_, the objects below it in the order of places
    {
        uint32_t first_child = 0, child_count = 0;
        uint32_t first_place = 0, place_count = 0;
    };
    struct Item
    {
        std::array<float, 3> center;
        uint32_t object;
    };
    class Builder;

    std::span<Child> childrenOf(size_t node)
    {
        return std::span(children_).subspan(nodes_[node].first_child, nodes_[node].child_count);
    }
    void arrange(std::span<const ObjectBox> boxes);
    /// Orders the items by the children that they are to hang below.
    static void divide(std::span<const Child> children, std::span<Item> items);

    double drift_;
    double built_cost_ = 0; // when objects were hung
    bool can_change_ = false;
    std::vector<Node> nodes_; // in the order of a walk: parents come first
    std::vector<Child> children_;
    std::vector<gpu::PosedObject> places_;
    std::vector<uint32_t> order_, before_; // objects by place: now, and before the last change
    std::vector<uint32_t> roots_;          // by object, in the hierarchy
    std::vector<ObjectBox> boxes_;         // by node, of cost()
    std::vector<Item> items_;              // by place, of arrange()
};
