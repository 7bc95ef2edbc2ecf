// The tree above moving objects: whatever its shape, each object hangs in it once, below boxes that are as small as they were.
#include "runtime/object_tree.h"

#include "format/stored_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <random>
#include <set>

namespace
{
using Planes = package::NodePlanes;

/// A hierarchy in the order of a walk.
class Hierarchy
{
public:
    explicit Hierarchy(uint32_t seed) : random_(seed) {}

    /// Object after object below a tree whose nodes have `least` to 4 children. @param boxes of the objects, in that order
    uint32_t grow(std::span<const ObjectBox> boxes, uint32_t least)
    {
        if (boxes.size() == 1)
            return addObject(boxes[0]);
        const uint32_t node = addNode();
        const size_t children = std::min<size_t>(boxes.size(), least + below(5 - least));
        for (size_t c = 0, first = 0; c < children; ++c)
        {
            const size_t left = boxes.size() - first, others = children - c - 1;
            const size_t count = others == 0 ? left : std::min(left - others, (left + others) / (others + 1));
            setChild(node, c, grow(boxes.subspan(first, count), least), around(boxes.subspan(first, count)));
            first += count;
        }
        return node;
    }

    /// A node of `children` leaves that stand still, to the left of what moves.
    uint32_t addStill(uint32_t children)
    {
        const uint32_t node = addNode();
        for (uint32_t c = 0; c < children; ++c)
            setChild(node, c, gpu::kLeafBit | c, {{0, 0, 0}, {1, 1, 1}});
        return node;
    }

    uint32_t addNode()
    {
        Planes planes;
        planes.child.fill(gpu::kNone);
        for (size_t i = 0; i < 6; ++i)
            planes.at[i].fill(i % 2 == 0 ? ObjectBox::kMost : -ObjectBox::kMost);
        nodes.push_back(std::bit_cast<gpu::BvhNode>(planes));
        return uint32_t(nodes.size() - 1);
    }

    void setChild(uint32_t node, size_t child, uint32_t reference, const ObjectBox& box)
    {
        auto planes = std::bit_cast<Planes>(nodes[node]);
        planes.child[child] = reference;
        for (size_t axis = 0; axis < 3; ++axis)
        {
            planes.at[2 * axis][child] = box.low[axis];
            planes.at[2 * axis + 1][child] = box.high[axis];
        }
        nodes[node] = std::bit_cast<gpu::BvhNode>(planes);
    }

    static ObjectBox around(std::span<const ObjectBox> boxes)
    {
        ObjectBox all;
        for (const ObjectBox& box : boxes)
            all.grow(box);
        return all;
    }

    std::vector<gpu::BvhNode> nodes;
    std::vector<package::MovingRange> objects;

private:
    /// Two nodes, the outer one with a leaf beside the inner one.
    uint32_t addObject(const ObjectBox& box)
    {
        const uint32_t root = addNode(), inner = addNode();
        setChild(root, 0, inner, box);
        setChild(root, 1, gpu::kLeafBit | 100, box);
        setChild(inner, 0, gpu::kLeafBit | 101, box);
        objects.push_back({root, 2, 0, 0, 0, 0, 0});
        return root;
    }
    uint32_t below(uint32_t count) { return uint32_t(random_() % count); }

    std::mt19937 random_;
};

std::vector<ObjectBox> randomBoxes(size_t count, uint32_t seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit;
    std::vector<ObjectBox> boxes(count);
    for (ObjectBox& box : boxes)
        for (size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = 100 * unit(random);
            box.high[axis] = box.low[axis] + unit(random);
        }
    return boxes;
}

/// Boxes near each other along x follow each other.
std::vector<ObjectBox> sortedBoxes(size_t count, uint32_t seed)
{
    std::vector<ObjectBox> boxes = randomBoxes(count, seed);
    std::ranges::sort(boxes, {}, [](const ObjectBox& box) { return box.low[0]; });
    return boxes;
}

/// What a walk over the tree above the objects finds.
struct Walk
{
    std::map<uint32_t, uint32_t> objects; // how often, by root
    std::set<uint32_t> nodes;             // above them
    std::vector<uint32_t> counts;         // objects below these, in the order of the walk
    double cost = 0;
    uint32_t stack = 0;
};

class Walker
{
public:
    Walker(const Hierarchy& tree, uint32_t first, std::span<const ObjectBox> boxes)
        : tree_(tree), first_(first), boxes_(boxes)
    {
        walk_.stack = visit(0).stack;
    }
    const Walk& walk() const { return walk_; }

private:
    struct Below
    {
        ObjectBox box;
        uint32_t count = 0, stack = 0;
    };

    Below visit(uint32_t node)
    {
        const auto object = std::ranges::find(tree_.objects, node, &package::MovingRange::root_node);
        const auto planes = std::bit_cast<Planes>(tree_.nodes[node]);
        const bool moves = node >= first_;
        Below here;
        if (object != tree_.objects.end())
        {
            ++walk_.objects[node];
            return {boxes_[size_t(object - tree_.objects.begin())], 1, 1}; // the stack of addObject()'s nodes
        }
        EXPECT_TRUE(!moves || walk_.nodes.insert(node).second) << node << " hangs twice";
        const size_t number = walk_.counts.size();
        walk_.counts.push_back(0);
        uint32_t children = 0;
        for (const uint32_t child : planes.child)
        {
            if (child == gpu::kNone)
                continue;
            ++children;
            if ((child & gpu::kLeafBit) != 0)
                continue;
            const Below below = visit(child);
            here.stack = std::max(here.stack, below.stack);
            if (child < first_)
                continue;
            here.box.grow(below.box);
            here.count += below.count;
            walk_.cost += below.box.halfArea();
        }
        here.stack += children - 1;
        walk_.counts[number] = here.count;
        return here;
    }

    const Hierarchy& tree_;
    uint32_t first_;
    std::span<const ObjectBox> boxes_;
    Walk walk_;
};

/// A root with what stands still and with as many trees of objects as it may have.
struct Case
{
    size_t objects;
    uint32_t least_children;
    uint32_t trees; // 0: nothing stands still, and the tree of objects is all
};

class ObjectTrees : public testing::TestWithParam<Case>
{
protected:
    ObjectTrees() : boxes_(sortedBoxes(GetParam().objects, 1)), hierarchy_(2)
    {
        const auto& [objects, least, trees] = GetParam();
        if (trees == 0)
        {
            hierarchy_.grow(boxes_, least);
            return;
        }
        const uint32_t root = hierarchy_.addNode();
        hierarchy_.setChild(root, 0, hierarchy_.addStill(3), {{0, 0, 0}, {1, 1, 1}});
        first_ = uint32_t(hierarchy_.nodes.size());
        for (uint32_t t = 0; t < trees; ++t)
        {
            const size_t begin = t * objects / trees, end = (t + 1) * objects / trees;
            const auto part = std::span(boxes_).subspan(begin, end - begin);
            hierarchy_.setChild(root, 1 + t, hierarchy_.grow(part, least), Hierarchy::around(part));
        }
    }

    /// Walks after having hung the objects where they are said to.
    Walk hang(std::span<const gpu::PosedObject> places, std::span<const ObjectBox> boxes)
    {
        for (const gpu::PosedObject& place : places)
            (&hierarchy_.nodes[place.link / gpu::kBvhWidth].child.x)[place.link % gpu::kBvhWidth] = place.node;
        return Walker(hierarchy_, first_, boxes).walk();
    }

    std::vector<ObjectBox> boxes_; // by object, as they are at rest
    Hierarchy hierarchy_;
    uint32_t first_ = 0;
};

TEST_P(ObjectTrees, HoldEachObjectOnceAndAreAsGoodAgain)
{
    ObjectTree tree(hierarchy_.nodes, first_, hierarchy_.objects);
    ASSERT_TRUE(tree.canChange());
    const Walk rest = hang({}, boxes_);
    // Sums of fewer than 2000 numbers, in another order.
    const auto same = [](double a, double b) { return std::abs(a - b) <= std::ldexp(2000.0, -53) * std::max(a, b); };
    EXPECT_TRUE(same(tree.cost(boxes_), rest.cost));
    EXPECT_TRUE(tree.update(boxes_).empty()); // nothing has moved

    std::vector<ObjectBox> moved = randomBoxes(boxes_.size(), 7);
    moved[3] = moved[moved.size() / 2] = {}; // hidden
    const double drifted = hang({}, moved).cost;
    const auto places = tree.update(moved);
    ASSERT_EQ(places.size(), moved.size());
    const Walk walk = hang(places, moved);
    EXPECT_EQ(walk.objects.size(), moved.size());
    for (const auto& [root, count] : walk.objects)
        EXPECT_EQ(count, 1u) << root;
    EXPECT_EQ(walk.nodes, rest.nodes);
    EXPECT_EQ(walk.counts, rest.counts);
    EXPECT_EQ(walk.stack, rest.stack); // objects are alike
    EXPECT_TRUE(same(tree.cost(moved), walk.cost));
    EXPECT_LT(walk.cost, drifted);
    EXPECT_TRUE(tree.update(moved).empty());
}

TEST_P(ObjectTrees, StayWhereNothingDrifts)
{
    ObjectTree tree(hierarchy_.nodes, first_, hierarchy_.objects);
    for (ObjectBox& box : boxes_)
        for (float& low : box.low)
            low -= 0.001f;
    EXPECT_TRUE(tree.update(boxes_).empty());
    ObjectTree never(hierarchy_.nodes, first_, hierarchy_.objects, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(never.update(randomBoxes(boxes_.size(), 8)).empty());
}

INSTANTIATE_TEST_SUITE_P(OfShapes, ObjectTrees,
                         testing::Values(Case{300, 4, 0}, Case{300, 4, 1}, Case{77, 2, 0}, Case{500, 2, 3},
                                         Case{41, 1, 2}));

TEST(ObjectTree, SeparatesHalvesAlongAnAxis)
{
    const std::vector<ObjectBox> rest = sortedBoxes(256, 3);
    Hierarchy hierarchy(4);
    hierarchy.grow(rest, 4);
    ObjectTree tree(hierarchy.nodes, 0, hierarchy.objects);
    const std::vector<ObjectBox> moved = randomBoxes(256, 5);
    const auto places = tree.update(moved);
    ASSERT_EQ(places.size(), 256u);
    // Of the root's four children of 64 objects, the first two are apart from the others, and from each other.
    const auto apart = [&](size_t first, size_t middle, size_t end)
    {
        for (size_t axis = 0; axis < 3; ++axis)
        {
            const auto center = [&](const gpu::PosedObject& place)
            {
                const auto object = std::ranges::find(hierarchy.objects, place.node, &package::MovingRange::root_node);
                const ObjectBox& box = moved[size_t(object - hierarchy.objects.begin())];
                return 0.5f * box.low[axis] + 0.5f * box.high[axis];
            };
            float most = -ObjectBox::kMost, least = ObjectBox::kMost;
            for (size_t i = first; i < end; ++i)
                (i < middle ? most : least) =
                    i < middle ? std::max(most, center(places[i])) : std::min(least, center(places[i]));
            if (most <= least)
                return true;
        }
        return false;
    };
    EXPECT_TRUE(apart(0, 128, 256));
    EXPECT_TRUE(apart(0, 64, 128));
    EXPECT_TRUE(apart(128, 192, 256));
}

TEST(ObjectTree, StaysWhereNoOrderCanHelpOrTheStackCouldOverflow)
{
    Hierarchy few(1);
    few.grow(randomBoxes(4, 1), 4);
    EXPECT_FALSE(ObjectTree(few.nodes, 0, few.objects).canChange());

    // A row of nodes, each with an object and the next one: two entries a level, and one for the object.
    const auto row = [](uint32_t levels)
    {
        Hierarchy hierarchy(1);
        const std::vector<ObjectBox> boxes = randomBoxes(2 * levels, 1);
        uint32_t parent = gpu::kNone;
        for (uint32_t level = 0; level < levels; ++level)
        {
            const uint32_t node = hierarchy.addNode();
            if (parent != gpu::kNone)
                hierarchy.setChild(parent, 2, node, boxes[0]);
            for (uint32_t c = 0; c < 2; ++c)
                hierarchy.setChild(node, c, hierarchy.grow(std::span(boxes).subspan(2 * level + c, 1), 1), boxes[0]);
            parent = node;
        }
        return hierarchy;
    };
    const Hierarchy fits = row(32), exceeds = row(33); // 31 x 2 + 1 + 1, and two more
    EXPECT_TRUE(ObjectTree(fits.nodes, 0, fits.objects).canChange());
    EXPECT_FALSE(ObjectTree(exceeds.nodes, 0, exceeds.objects).canChange());
}

TEST(ObjectTree, OfNothingStays)
{
    Hierarchy still(1);
    still.addStill(4);
    ObjectTree tree(still.nodes, 1, {});
    EXPECT_FALSE(tree.canChange());
    EXPECT_TRUE(tree.update({}).empty());
}
} // namespace
