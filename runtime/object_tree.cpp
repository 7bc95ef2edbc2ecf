#include "runtime/object_tree.h"

#include "format/check.h"
#include "format/stored_geometry.h"

#include <algorithm>
#include <bit>

void ObjectBox::grow(const ObjectBox& other)
{
    for (size_t axis = 0; axis < 3; ++axis)
    {
        low[axis] = std::min(low[axis], other.low[axis]);
        high[axis] = std::max(high[axis], other.high[axis]);
    }
}

double ObjectBox::halfArea() const
{
    if (isEmpty())
        return 0;
    const double x = double(high[0]) - low[0], y = double(high[1]) - low[1], z = double(high[2]) - low[2];
    return x * y + y * z + z * x;
}

/// Finds the tree above objects in a package's nodes, which are in the order of a walk: parents come before their children.
class ObjectTree::Builder
{
public:
    Builder(ObjectTree& tree, std::span<const gpu::BvhNode> nodes, uint32_t first,
            std::span<const package::MovingRange> objects)
        : tree_(tree), nodes_(nodes), first_(first), object_at_(nodes.size() - first, gpu::kNone),
          number_(nodes.size() - first)
    {
        for (uint32_t object = 0; object < objects.size(); ++object)
            object_at_[objects[object].root_node - first] = object;
        if (first > 0) // the root, which has other children, too
            addNode(0);
        for (uint32_t node = first; node < nodes.size();)
            if (const uint32_t object = object_at_[node - first]; object != gpu::kNone)
                node += objects[object].node_count;
            else
            {
                number_[node - first] = uint32_t(tree.nodes_.size());
                addNode(node++);
            }
        countObjects();
        placeObjects();
    }

    /// Traversal entries that no order of the objects exceeds: those of the place that has most above it, and those of the
    /// object that asks for most.
    uint32_t mostStack() const
    {
        std::vector<uint32_t> need(object_at_.size());
        uint32_t most_of_object = 0;
        for (size_t i = need.size(); i-- > 0;)
        {
            const auto planes = planesOf(first_ + uint32_t(i));
            for (const uint32_t child : planes.child)
                if (child != gpu::kNone && (child & gpu::kLeafBit) == 0)
                    need[i] = std::max(need[i], need[child - first_]);
            need[i] += childCount(planes) - 1;
            if (object_at_[i] != gpu::kNone)
                most_of_object = std::max(most_of_object, need[i]);
        }
        std::vector<uint32_t> above(tree_.nodes_.size());
        uint32_t most_above = 0;
        for (size_t i = 0; i < above.size(); ++i)
        {
            above[i] += childCount(planesOf(index_[i])) - 1;
            most_above = std::max(most_above, above[i]);
            for (const Child& child : tree_.childrenOf(i))
                if (child.node != gpu::kNone)
                    above[child.node] = above[i];
        }
        return most_above + most_of_object;
    }

    /// ObjectTree::cost() of the boxes in the package.
    double cost() const
    {
        double sum = 0;
        for (const Child& child : tree_.children_)
        {
            const auto planes = planesOf(child.link / gpu::kBvhWidth);
            const uint32_t c = child.link % gpu::kBvhWidth;
            sum += ObjectBox{{planes.at[0][c], planes.at[2][c], planes.at[4][c]},
                             {planes.at[1][c], planes.at[3][c], planes.at[5][c]}}
                       .halfArea();
        }
        return sum;
    }

private:
    package::NodePlanes planesOf(uint32_t node) const { return std::bit_cast<package::NodePlanes>(nodes_[node]); }
    static uint32_t childCount(const package::NodePlanes& planes)
    {
        return uint32_t(std::ranges::count_if(planes.child, [](uint32_t child) { return child != gpu::kNone; }));
    }
    uint32_t indexOf(const Child& child) const
    {
        return (&nodes_[child.link / gpu::kBvhWidth].child.x)[child.link % gpu::kBvhWidth];
    }

    void addNode(uint32_t index)
    {
        const auto planes = planesOf(index);
        Node node{.first_child = uint32_t(tree_.children_.size())};
        for (uint32_t c = 0; c < gpu::kBvhWidth; ++c)
            if (const uint32_t child = planes.child[c];
                child != gpu::kNone && (child & gpu::kLeafBit) == 0 && child >= first_)
            {
                tree_.children_.push_back({.link = gpu::kBvhWidth * index + c, .node = gpu::kNone, .count = 1});
                ++node.child_count;
            }
        tree_.nodes_.push_back(node);
        index_.push_back(index);
    }

    void countObjects()
    {
        for (size_t i = tree_.nodes_.size(); i-- > 0;)
            for (Child& child : tree_.childrenOf(i))
            {
                const uint32_t index = indexOf(child) - first_;
                if (object_at_[index] == gpu::kNone)
                {
                    child.node = number_[index];
                    child.count = tree_.nodes_[child.node].place_count;
                }
                tree_.nodes_[i].place_count += child.count;
            }
    }

    void placeObjects()
    {
        const size_t count = tree_.nodes_.empty() ? 0 : tree_.nodes_[0].place_count;
        tree_.places_.resize(count);
        tree_.order_.resize(count);
        for (size_t i = 0; i < tree_.nodes_.size(); ++i)
        {
            uint32_t place = tree_.nodes_[i].first_place;
            for (const Child& child : tree_.childrenOf(i))
            {
                if (child.node != gpu::kNone)
                    tree_.nodes_[child.node].first_place = place;
                else
                {
                    tree_.places_[place] = {.link = child.link, .node = indexOf(child)};
                    tree_.order_[place] = object_at_[indexOf(child) - first_];
                }
                place += child.count;
            }
        }
    }

    ObjectTree& tree_;
    std::span<const gpu::BvhNode> nodes_;
    uint32_t first_;
    std::vector<uint32_t> object_at_; // by moving node, of which it is the root
    std::vector<uint32_t> number_;    // by moving node: in ObjectTree::nodes_
    std::vector<uint32_t> index_;     // by node of ObjectTree: the package's
};

ObjectTree::ObjectTree(std::span<const gpu::BvhNode> nodes, uint32_t first_moving_node,
                       std::span<const package::MovingRange> objects, double drift)
    : drift_(drift)
{
    const Builder builder(*this, nodes, first_moving_node, objects);
    can_change_ = nodes_.size() > 1 && builder.mostStack() <= gpu::kTraversalStackSize;
    if (!can_change_)
        return;
    check(order_.size() == objects.size(), "{} places for {} objects", order_.size(), objects.size());
    built_cost_ = builder.cost();
    for (const package::MovingRange& object : objects)
        roots_.push_back(object.root_node);
    before_.resize(order_.size());
    items_.resize(order_.size());
    boxes_.resize(nodes_.size());
}

double ObjectTree::cost(std::span<const ObjectBox> boxes)
{
    double sum = 0;
    for (size_t i = nodes_.size(); i-- > 0;)
    {
        uint32_t place = nodes_[i].first_place;
        boxes_[i] = {};
        for (const Child& child : childrenOf(i))
        {
            const ObjectBox& box = child.node == gpu::kNone ? boxes[order_[place]] : boxes_[child.node];
            sum += box.halfArea();
            boxes_[i].grow(box);
            place += child.count;
        }
    }
    return sum;
}

std::span<const gpu::PosedObject> ObjectTree::update(std::span<const ObjectBox> boxes)
{
    if (!can_change_)
        return {};
    check(boxes.size() == order_.size(), "{} boxes of {} objects", boxes.size(), order_.size());
    const double now = cost(boxes);
    // Less may be worse, too: where all objects have become smaller, or have come closer, and change places.
    if (now <= drift_ * built_cost_ && built_cost_ <= drift_ * now)
        return {};
    std::ranges::copy(order_, before_.begin());
    arrange(boxes);
    built_cost_ = cost(boxes);
    if (built_cost_ >= now)
    {
        std::ranges::copy(before_, order_.begin());
        built_cost_ = now;
        return {};
    }
    for (size_t place = 0; place < order_.size(); ++place)
        places_[place].node = roots_[order_[place]];
    return places_;
}

void ObjectTree::arrange(std::span<const ObjectBox> boxes)
{
    for (uint32_t object = 0; object < boxes.size(); ++object)
    {
        const ObjectBox& box = boxes[object];
        for (size_t axis = 0; axis < 3; ++axis) // those of nothing come together, at the low side
            items_[object].center[axis] =
                box.isEmpty() ? -ObjectBox::kMost : 0.5f * box.low[axis] + 0.5f * box.high[axis];
        items_[object].object = object;
    }
    for (size_t i = 0; i < nodes_.size(); ++i)
    {
        const std::span<const Child> children = childrenOf(i);
        divide(children, std::span(items_).subspan(nodes_[i].first_place, nodes_[i].place_count));
    }
    for (size_t place = 0; place < order_.size(); ++place)
        order_[place] = items_[place].object;
}

void ObjectTree::divide(std::span<const Child> children, std::span<Item> items)
{
    if (children.size() < 2)
        return;
    std::array<float, 3> low, high;
    low.fill(ObjectBox::kMost);
    high.fill(-ObjectBox::kMost);
    for (const Item& item : items)
        for (size_t axis = 0; axis < 3 && item.center[0] > -ObjectBox::kMost; ++axis)
        {
            low[axis] = std::min(low[axis], item.center[axis]);
            high[axis] = std::max(high[axis], item.center[axis]);
        }
    size_t longest = 0;
    for (const size_t axis : {1, 2})
        if (double(high[axis]) - low[axis] > double(high[longest]) - low[longest])
            longest = axis;
    const auto half = children.first(children.size() / 2);
    size_t count = 0;
    for (const Child& child : half)
        count += child.count;
    std::ranges::nth_element(items, items.begin() + ptrdiff_t(count),
                             [&](const Item& a, const Item& b) {
                                 return a.center[longest] != b.center[longest] ? a.center[longest] < b.center[longest]
                                                                               : a.object < b.object;
                             });
    divide(half, items.first(count));
    divide(children.subspan(half.size()), items.subspan(count));
}
