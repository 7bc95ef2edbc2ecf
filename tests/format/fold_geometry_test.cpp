// Geometry that is folded, written, read and unfolded is what it was; boxes are at most a little larger.
#include "format/fold_geometry.h"
#include "tests/format/sample_package.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace
{
using package::NodeBox;
using package::NodePlanes;

/// A tree over random triangles, a corner of each in a box that need not hold the triangle (as after spatial splits).
class RandomGeometry
{
public:
    RandomGeometry(uint32_t seed, float scale, float offset) : random_(seed)
    {
        for (uint32_t i = 0; i < 3 * kTriangles; ++i)
        {
            positions.push_back({offset + scale * unit(), scale * unit(), offset - scale * unit()});
            attributes.push_back({i, ~i, {unit(), -unit()}, {}, {0x3c003c00, 0x3c003c00}});
        }
        for (uint32_t i = 0; i < kTriangles; ++i)
            triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        low = high = positions[0];
        for (const gpu::vec3& p : positions)
        {
            low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        addNode({{low.x, low.y, low.z}, {high.x, high.y, high.z}}, 6);
    }

    package::Geometry geometry() const { return {low, high, nodes, leaf_triangles, triangles, positions, attributes}; }

    std::vector<gpu::BvhNode> nodes;
    std::vector<gpu::BvhTriangle> leaf_triangles;
    std::vector<gpu::uvec3> triangles;
    std::vector<gpu::vec3> positions;
    std::vector<gpu::VertexAttributes> attributes;
    gpu::vec3 low, high;

private:
    static constexpr uint32_t kTriangles = 200;

    float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
    uint32_t below(uint32_t n) { return uint32_t(random_() % n); }

    uint32_t addLeaf()
    {
        const uint32_t count = 1 + below(8), first = uint32_t(leaf_triangles.size());
        for (uint32_t i = 0; i < count; ++i)
        {
            const uint32_t t = next_ < kTriangles ? next_++ : below(kTriangles);
            leaf_triangles.push_back({positions[3 * t], t, positions[3 * t + 1], t % 4, positions[3 * t + 2], 0});
        }
        return gpu::kLeafBit | (count - 1) << gpu::kLeafCountShift | first;
    }

    uint32_t addNode(const NodeBox& box, uint32_t levels)
    {
        const auto index = uint32_t(nodes.size());
        nodes.emplace_back();
        NodePlanes planes;
        for (uint32_t c = 0; c < gpu::kBvhWidth; ++c)
        {
            NodeBox inside = box;
            for (size_t axis = 0; axis < 3; ++axis)
            {
                float a = std::lerp(box.low[axis], box.high[axis], unit()),
                      b = std::lerp(box.low[axis], box.high[axis], unit());
                if (below(4) == 0) // touches its node's side, or has no width
                    a = box.low[axis];
                if (below(8) == 0)
                    b = a;
                inside.low[axis] = std::clamp(std::min(a, b), box.low[axis], box.high[axis]);
                inside.high[axis] = std::clamp(std::max(a, b), box.low[axis], box.high[axis]);
            }
            const bool present = c == 0 || below(5) > 0;
            for (size_t axis = 0; axis < 3; ++axis)
            {
                planes.at[2 * axis][c] = present ? inside.low[axis] : std::numeric_limits<float>::max();
                planes.at[2 * axis + 1][c] = present ? inside.high[axis] : std::numeric_limits<float>::lowest();
            }
            planes.child[c] = !present                       ? gpu::kNone
                              : levels == 0 || below(3) == 0 ? addLeaf()
                                                             : addNode(inside, levels - 1);
        }
        nodes[index] = std::bit_cast<gpu::BvhNode>(planes);
        return index;
    }

    std::mt19937 random_;
    uint32_t next_ = 0; // the first that is in no leaf
};

std::vector<std::byte> write(const package::StoredGeometry& geometry, const gpu::vec3& low, const gpu::vec3& high)
{
    SamplePackage sample; // for its materials
    sample.nodes = geometry.nodes;
    sample.leaf_triangles = geometry.leaf_triangles;
    sample.triangles = geometry.triangles;
    sample.positions.assign(geometry.positions.begin(), geometry.positions.end());
    sample.vertices = geometry.vertices;
    sample.extras = geometry.extras;
    *sample.meta.bounds_min = {low.x, low.y, low.z};
    *sample.meta.bounds_max = {high.x, high.y, high.z};
    sample.meta.has_alpha = sample.meta.has_thin = false;
    return sample.bytes();
}

/// Boxes hold those that were written and exceed them by less than two steps of the box around them, or by rounding.
void expectBoxes(std::span<const gpu::BvhNode> read, std::span<const gpu::BvhNode> written, uint32_t index,
                 const NodeBox& around)
{
    const auto now = std::bit_cast<NodePlanes>(read[index]), was = std::bit_cast<NodePlanes>(written[index]);
    ASSERT_EQ(now.child, was.child);
    for (uint32_t c = 0; c < gpu::kBvhWidth; ++c)
    {
        if (now.child[c] == gpu::kNone)
        {
            EXPECT_GT(now.at[0][c], now.at[1][c]);
            continue;
        }
        NodeBox box;
        for (size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = now.at[2 * axis][c];
            box.high[axis] = now.at[2 * axis + 1][c];
            const double side = double(around.high[axis]) - around.low[axis];
            const double rounding = 0x1p-23 * std::max(std::abs(around.low[axis]), std::abs(around.high[axis]));
            EXPECT_LE(box.low[axis], was.at[2 * axis][c]);
            EXPECT_GE(box.high[axis], was.at[2 * axis + 1][c]);
            EXPECT_LE(double(was.at[2 * axis][c]) - box.low[axis], 2 * side / 65535 + rounding);
            EXPECT_LE(double(box.high[axis]) - was.at[2 * axis + 1][c], 2 * side / 65535 + rounding);
        }
        if ((now.child[c] & gpu::kLeafBit) == 0)
            expectBoxes(read, written, now.child[c], box);
    }
}
} // namespace

TEST(FoldGeometry, ComesBackAsItWasWithBoxesAtMostALittleLarger)
{
    for (const auto& [scale, offset] :
         {std::pair(1.0f, 0.0f), std::pair(1000.0f, -500.0f), std::pair(0.125f, 4096.0f), std::pair(1e-3f, 0.0f)})
        for (uint32_t seed = 0; seed < 4; ++seed)
        {
            const RandomGeometry made(seed, scale, offset);
            const package::StoredGeometry stored = foldGeometry(made.geometry());
            EXPECT_TRUE(stored.extras.empty());
            const std::vector<std::byte> bytes = write(stored, made.low, made.high);
            const auto package = package::Package::openBytes(bytes);
            ASSERT_TRUE(package) << package.error().message;
            ASSERT_EQ(package->bvhNodes().size(), made.nodes.size());
            expectBoxes(package->bvhNodes(), made.nodes, 0, package::rootBox(made.low, made.high));
            ASSERT_EQ(package->bvhTriangles().size(), made.leaf_triangles.size());
            EXPECT_EQ(std::memcmp(package->bvhTriangles().data(), made.leaf_triangles.data(),
                                  package->bvhTriangles().size_bytes()),
                      0);
            ASSERT_EQ(package->vertexAttributes().size(), made.attributes.size());
            EXPECT_EQ(std::memcmp(package->vertexAttributes().data(), made.attributes.data(),
                                  package->vertexAttributes().size_bytes()),
                      0);
        }
}

TEST(FoldGeometry, KeepsSecondCoordinatesAndColoursWhereAVertexHasThem)
{
    RandomGeometry made(1, 1, 0);
    made.attributes[7].uv1 = {0.25f, 0.5f};
    made.attributes[8].color = {0, 0x3c003800};
    const package::StoredGeometry stored = foldGeometry(made.geometry());
    const std::vector<std::byte> bytes = write(stored, made.low, made.high);
    const auto package = package::Package::openBytes(bytes);
    ASSERT_TRUE(package) << package.error().message;
    ASSERT_EQ(package->vertexAttributes().size(), made.attributes.size());
    EXPECT_EQ(std::memcmp(package->vertexAttributes().data(), made.attributes.data(),
                          package->vertexAttributes().size_bytes()),
              0);
}

TEST(FoldGeometry, StepsNeverLeaveAPlaneOutside)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 100000; ++i)
    {
        const float low = (unit(random) - 0.5f) * std::exp2f(20 * unit(random) - 10);
        const float high = low + std::exp2f(40 * unit(random) - 30);
        const float plane = std::clamp(std::lerp(low, high, unit(random)), low, high);
        const package::BoxSteps steps(low, high);
        ASSERT_LE(steps.low(steps.toLow(plane)), plane) << low << " " << high;
        ASSERT_GE(steps.high(steps.toHigh(plane)), plane) << low << " " << high;
        ASSERT_EQ(steps.low(0), low);
        ASSERT_EQ(steps.high(0), high);
        ASSERT_GE(steps.low(65535), low);
    }
}
