// The tree over spheres against one built by recursion, and its bounds against all spheres of each node.
#include "tests/stages/gi_test.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/triangle_scene.h"

#include <bit>
#include <numeric>

namespace
{
constexpr uint32_t kCells = 1024; // a side of the grid of Morton codes

constexpr gpu::SceneInfo kCube{.bounds_min = {-1, -1, -1}, .bounds_max = {1, 1, 1}};

/// A sphere in the middle of a cell of the scene's cube [-1, 1]^3, or a little off it: its code does not depend on rounding.
gpu::vec4 inCell(gpu::uvec3 cell, float radius = 0, float off = 0)
{
    const auto at = [&](uint32_t c) { return (c + 0.5 + off) / kCells; };
    const Double3 p = fromGridPlace(kCube, {at(cell.x), at(cell.y), at(cell.z)});
    return {float(p.x), float(p.y), float(p.z), radius};
}

uint32_t mortonCode(gpu::vec4 sphere)
{
    const Double3 place = gridPlace(kCube, {sphere.x, sphere.y, sphere.z});
    const auto cell = [](double p) { return uint32_t(std::min(p * kCells, kCells - 1.0)); };
    const uint32_t cells[3]{cell(place.x), cell(place.y), cell(place.z)};
    uint32_t code = 0;
    for (int bit = 9; bit >= 0; --bit)
        for (const uint32_t c : cells)
            code = code << 1 | (c >> bit & 1);
    return code;
}

struct Case
{
    const char* name;
    std::vector<gpu::vec4> spheres;
};

void PrintTo(const Case& value, std::ostream* out) // NOLINT: GoogleTest's name
{
    *out << value.name;
}

std::vector<gpu::vec4> randomSpheres(uint32_t count, float radius, gpu::uvec3 cells = {kCells, kCells, kCells})
{
    Random random(3);
    std::vector<gpu::vec4> spheres;
    for (uint32_t i = 0; i < count; ++i)
        spheres.push_back(inCell({random.below(cells.x), random.below(cells.y), random.below(cells.z)},
                                 radius * random.unit(), random.between(-0.4f, 0.4f)));
    return spheres;
}

std::vector<Case> cases()
{
    std::vector<gpu::vec4> far = randomSpheres(200, 0);
    for (size_t i = 0; i < far.size(); i += 3)
        far[i].x += 5; // outside of the scene: as if on its rim
    return {{"None", {}},
            {"One", randomSpheres(1, 1)},
            {"Two", randomSpheres(2, 0)},
            {"TwoEqual", {inCell({3, 4, 5}), inCell({3, 4, 5})}},
            {"Three", randomSpheres(3, 0)},
            {"Five", randomSpheres(5, 0.1f)},
            {"FiveEqual", std::vector(5, inCell({512, 0, 1023}))},
            {"AGroup", randomSpheres(64, 0)},
            {"OneMoreThanAGroup", randomSpheres(65, 0)},
            {"Points", randomSpheres(3001, 0)},
            {"Spheres", randomSpheres(2000, 0.3f)},
            {"OfAPlane", randomSpheres(1000, 0, {kCells, 1, kCells})},
            {"OfALine", randomSpheres(1000, 0, {1, kCells, 1})},
            {"AllEqual", std::vector(1000, inCell({700, 7, 70}, 0.25f))},
            {"InEightCells", randomSpheres(1000, 0.01f, {2, 2, 2})},
            {"OutsideOfTheScene", far}};
}

class Trees : public GiTest, public testing::WithParamInterface<Case>
{
};

/// Where a range of sorted codes divides: at the highest bit in which its ends differ, of indices where the codes do
/// not.
uint32_t splitOf(std::span<const uint32_t> codes, uint32_t first, uint32_t last)
{
    const bool equal = codes[first] == codes[last];
    const auto word = [&](uint32_t i) { return equal ? i : codes[i]; };
    const uint32_t highest = std::bit_floor(word(first) ^ word(last));
    uint32_t split = first;
    while ((word(split + 1) & highest) == 0)
        ++split;
    return split; // last of the left child
}

struct Walk
{
    const TreeData& tree;
    std::span<const uint32_t> codes; // sorted
    std::span<const gpu::vec4> spheres;
    std::vector<uint32_t> leaf_visits, node_visits;
    uint32_t deepest = 0;

    void expectBounds(uint32_t first, uint32_t end, gpu::vec3 low, gpu::vec3 high)
    {
        gpu::vec3 least{kFar, kFar, kFar}, most{-kFar, -kFar, -kFar};
        for (uint32_t i = first; i < end; ++i)
        {
            const gpu::vec4 s = spheres[tree.order[i]];
            least = {std::min(least.x, s.x - s.w), std::min(least.y, s.y - s.w), std::min(least.z, s.z - s.w)};
            most = {std::max(most.x, s.x + s.w), std::max(most.y, s.y + s.w), std::max(most.z, s.z + s.w)};
        }
        for (const auto& [got, want] : {std::pair{low, least}, {high, most}})
            EXPECT_TRUE(got.x == want.x && got.y == want.y && got.z == want.z)
                << "spheres " << first << " to " << end << ": " << got.x << ' ' << got.y << ' ' << got.z << " is not "
                << want.x << ' ' << want.y << ' ' << want.z;
    }

    /// @param child as stored by its parent, whose index and side are `parent`
    void expectChild(uint32_t child, uint32_t first, uint32_t end, uint32_t parent, uint32_t depth)
    {
        const uint32_t index = child & ~gpu::kTreeLeafBit;
        EXPECT_EQ((child & gpu::kTreeLeafBit) != 0, end - first == 1) << "spheres " << first << " to " << end;
        if ((child & gpu::kTreeLeafBit) != 0)
        {
            EXPECT_EQ(index, first);
            EXPECT_EQ(tree.leaf_parents[index], parent);
            ++leaf_visits[index];
            deepest = std::max(deepest, depth);
            return;
        }
        EXPECT_EQ(tree.node_parents[index], parent);
        expectNode(index, first, end, depth);
    }

    void expectNode(uint32_t index, uint32_t first, uint32_t end, uint32_t depth)
    {
        ASSERT_LT(index, tree.nodes.size());
        ++node_visits[index];
        const gpu::TreeNode& node = tree.nodes[index];
        ASSERT_EQ(node.first, first) << index;
        ASSERT_EQ(node.count, end - first) << index;
        const uint32_t split = splitOf(codes, first, end - 1);
        EXPECT_EQ(node.left & ~gpu::kTreeLeafBit, split);
        EXPECT_EQ(node.right & ~gpu::kTreeLeafBit, split + 1);
        expectBounds(first, split + 1, node.left_min, node.left_max);
        expectBounds(split + 1, end, node.right_min, node.right_max);
        expectChild(node.left, first, split + 1, index, depth + 1);
        expectChild(node.right, split + 1, end, index | gpu::kTreeLeafBit, depth + 1);
    }
};

TEST_P(Trees, AreThoseOfTheSortedMortonCodes)
{
    TriangleScene builder;
    builder.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 2});
    const LoadedScene scene = builder.load(device());
    const std::vector<gpu::vec4>& spheres = GetParam().spheres;
    const uint32_t count = uint32_t(spheres.size());
    const Buffer on_gpu = upload("test.spheres", spheres), size = sizeBuffer(count);
    const Tree stage(device(), "test.tree", std::max(count, 1u));
    submit(*scene.gpu, [&](Recorder& rec) { stage.record(rec, on_gpu, size); });
    submit(*scene.gpu, [&](Recorder& rec) { stage.record(rec, on_gpu, size); }); // again: nothing may be left over
    const TreeData tree = contents(stage, count);

    std::vector<uint32_t> order(count), codes;
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](uint32_t i) { return mortonCode(spheres[i]); });
    EXPECT_EQ(tree.order, order);
    for (const uint32_t i : order)
        codes.push_back(mortonCode(spheres[i]));
    if (count < 2 || HasFailure())
        return;
    Walk walk{.tree = tree,
              .codes = codes,
              .spheres = spheres,
              .leaf_visits = std::vector<uint32_t>(count),
              .node_visits = std::vector<uint32_t>(count - 1)};
    walk.expectNode(0, 0, count, 0);
    EXPECT_EQ(walk.leaf_visits, std::vector<uint32_t>(count, 1)); // each in exactly one leaf
    EXPECT_EQ(walk.node_visits, std::vector<uint32_t>(count - 1, 1));
    EXPECT_LE(walk.deepest, 62u); // the stack of lib/tree.glsl has room for 64
}

INSTANTIATE_TEST_SUITE_P(, Trees, testing::ValuesIn(cases()), [](const auto& c) { return c.param.name; });
} // namespace
