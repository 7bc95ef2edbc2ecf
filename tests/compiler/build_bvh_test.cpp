// The hierarchy against brute force: same closest hits, nothing missed, and its own figures recomputed.
#include "compiler/build_bvh.h"
#include "compiler/vector_math.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <optional>
#include <random>

namespace
{
struct Ray
{
    gpu::vec3 origin;
    gpu::vec3 direction;
};

struct Hit
{
    float t;
    uint32_t triangle;
};

/// Moeller and Trumbore 1997.
std::optional<float> intersect(const Ray& ray, const gpu::vec3& v0, const gpu::vec3& v1, const gpu::vec3& v2)
{
    const gpu::vec3 e1 = v1 - v0;
    const gpu::vec3 e2 = v2 - v0;
    const gpu::vec3 p = cross(ray.direction, e2);
    const float det = dot(e1, p);
    if (det == 0)
        return std::nullopt;
    const gpu::vec3 s = ray.origin - v0;
    const gpu::vec3 q = cross(s, e1);
    const float u = dot(s, p) / det;
    const float v = dot(ray.direction, q) / det;
    const float t = dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t <= 0)
        return std::nullopt;
    return t;
}

void keepNearer(std::optional<Hit>& best, std::optional<float> t, uint32_t triangle)
{
    if (t && (!best || *t < best->t || (*t == best->t && triangle < best->triangle)))
        best = Hit{*t, triangle};
}

std::optional<Hit> bruteForce(const WorldMesh& mesh, const Ray& ray)
{
    std::optional<Hit> best;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const gpu::uvec3& v = mesh.triangles[i];
        keepNearer(best, intersect(ray, mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]), i);
    }
    return best;
}

std::array<uint32_t, 4> children(const gpu::BvhNode& n)
{
    return {n.child.x, n.child.y, n.child.z, n.child.w};
}

std::array<std::array<gpu::vec3, 2>, 4> boxes(const gpu::BvhNode& n)
{
    return {{{{{n.min_x.x, n.min_y.x, n.min_z.x}, {n.max_x.x, n.max_y.x, n.max_z.x}}},
             {{{n.min_x.y, n.min_y.y, n.min_z.y}, {n.max_x.y, n.max_y.y, n.max_z.y}}},
             {{{n.min_x.z, n.min_y.z, n.min_z.z}, {n.max_x.z, n.max_y.z, n.max_z.z}}},
             {{{n.min_x.w, n.min_y.w, n.min_z.w}, {n.max_x.w, n.max_y.w, n.max_z.w}}}}};
}

/// A plain slab test, no safety margin of its own.
bool meets(const Ray& ray, const std::array<gpu::vec3, 2>& box)
{
    const gpu::vec3 inverse{1 / ray.direction.x, 1 / ray.direction.y, 1 / ray.direction.z};
    const auto scaled = [&](const gpu::vec3& p)
    {
        const gpu::vec3 d = p - ray.origin;
        return gpu::vec3{d.x * inverse.x, d.y * inverse.y, d.z * inverse.z};
    };
    const gpu::vec3 a = scaled(box[0]);
    const gpu::vec3 b = scaled(box[1]);
    const gpu::vec3 near = min(a, b);
    const gpu::vec3 far = max(a, b);
    return std::max({near.x, near.y, near.z, 0.0f}) <= std::min({far.x, far.y, far.z});
}

std::optional<Hit> traverse(const Bvh& bvh, const Ray& ray)
{
    std::optional<Hit> best;
    std::vector<uint32_t> stack{0};
    while (!stack.empty())
    {
        const gpu::BvhNode& node = bvh.nodes[stack.back()];
        stack.pop_back();
        for (uint32_t c = 0; c < 4; ++c)
        {
            const uint32_t reference = children(node)[c];
            if (reference == gpu::kNone || !meets(ray, boxes(node)[c]))
                continue;
            if ((reference & gpu::kLeafBit) == 0)
            {
                stack.push_back(reference);
                continue;
            }
            const uint32_t first = reference & gpu::kLeafFirstMask;
            const uint32_t count = (reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
            for (uint32_t i = first; i < first + count; ++i)
            {
                const gpu::BvhTriangle& t = bvh.triangles[i];
                keepNearer(best, intersect(ray, t.v0, t.v1, t.v2), t.triangle);
            }
        }
    }
    return best;
}

void addTriangle(WorldMesh& mesh, const gpu::vec3& a, const gpu::vec3& b, const gpu::vec3& c)
{
    const uint32_t first = uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.materials.push_back(uint32_t(mesh.triangles.size()) % 3);
    mesh.objects.push_back(0);
}

struct Random
{
    std::mt19937 engine{12345};
    float operator()(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine); }
    gpu::vec3 point(float low, float high)
    {
        const float x = (*this)(low, high);
        const float y = (*this)(low, high);
        return {x, y, (*this)(low, high)};
    }
};

/// Small ones and long thin ones: spatial splits have work.
WorldMesh randomMesh(uint32_t count)
{
    Random random;
    WorldMesh mesh;
    for (uint32_t i = 0; i < count; ++i)
    {
        const gpu::vec3 a = random.point(-10, 10);
        const float size = i % 20 == 0 ? 8.0f : 0.5f;
        addTriangle(mesh, a, a + random.point(-size, size), a + random.point(-size, size));
    }
    return mesh;
}

/// Axis-aligned squares in the planes y = 0 and x = 7, the way floors and walls come.
WorldMesh flatMesh()
{
    WorldMesh mesh;
    for (int i = 0; i < 12; ++i)
    {
        for (int j = 0; j < 12; ++j)
        {
            const float u = float(i) / 3;
            const float v = float(j) / 7;
            const float du = u + 1.0f / 3;
            const float dv = v + 1.0f / 7;
            addTriangle(mesh, {u, 0, v}, {du, 0, v}, {u, 0, dv});
            addTriangle(mesh, {du, 0, v}, {du, 0, dv}, {u, 0, dv});
            addTriangle(mesh, {7, u, v}, {7, du, v}, {7, u, dv});
            addTriangle(mesh, {7, du, v}, {7, du, dv}, {7, u, dv});
        }
    }
    return mesh;
}

Bvh build(const WorldMesh& mesh)
{
    return buildBvh(mesh, std::vector<uint32_t>(mesh.triangles.size(), 0));
}

uint32_t stackNeed(const Bvh& bvh, uint32_t node)
{
    uint32_t present = 0;
    uint32_t deepest = 0;
    for (const uint32_t reference : children(bvh.nodes[node]))
    {
        present += reference != gpu::kNone;
        if ((reference & gpu::kLeafBit) == 0)
            deepest = std::max(deepest, stackNeed(bvh, reference));
    }
    return present - 1 + deepest;
}

/// Every node but the root has one parent before it, every triangle is in some leaf, leaves tile the triangle list.
void expectSound(const Bvh& bvh, const WorldMesh& mesh)
{
    std::vector<uint32_t> parents(bvh.nodes.size());
    std::vector<bool> seen(mesh.triangles.size());
    size_t in_leaves = 0;
    for (uint32_t n = 0; n < bvh.nodes.size(); ++n)
    {
        for (const uint32_t reference : children(bvh.nodes[n]))
        {
            if (reference == gpu::kNone)
                continue;
            if ((reference & gpu::kLeafBit) == 0)
            {
                ASSERT_GT(reference, n);
                ASSERT_LT(reference, bvh.nodes.size());
                ++parents[reference];
                continue;
            }
            in_leaves += (reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
        }
    }
    EXPECT_EQ(std::count(parents.begin(), parents.end(), 1u), long(bvh.nodes.size()) - 1);
    EXPECT_EQ(in_leaves, bvh.triangles.size());
    for (const gpu::BvhTriangle& t : bvh.triangles)
    {
        ASSERT_LT(t.triangle, mesh.triangles.size());
        ASSERT_EQ(t.material, mesh.materials[t.triangle]);
        seen[t.triangle] = true;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), true), long(mesh.triangles.size()));
    EXPECT_EQ(bvh.traversal_stack, stackNeed(bvh, 0));
    EXPECT_LE(bvh.traversal_stack, gpu::kTraversalStackSize);
}

/// Rays at points of the triangles: whatever brute force hits, the hierarchy must hit alike.
void expectSameHits(const Bvh& bvh, const WorldMesh& mesh, uint32_t ray_count)
{
    Random random;
    uint32_t hits = 0;
    for (uint32_t i = 0; i < ray_count; ++i)
    {
        const gpu::uvec3& v = mesh.triangles[i % mesh.triangles.size()];
        const float a = random(0, 1);
        const float b = random(0, 1 - a);
        const gpu::vec3 target = mesh.positions[v.x] * (1 - a - b) + mesh.positions[v.y] * a + mesh.positions[v.z] * b;
        const gpu::vec3 origin = random.point(-12, 12);
        const Ray ray{origin, target - origin};
        const std::optional<Hit> expected = bruteForce(mesh, ray);
        const std::optional<Hit> got = traverse(bvh, ray);
        ASSERT_EQ(bool(got), bool(expected)) << "ray " << i;
        if (!expected)
            continue;
        ASSERT_EQ(got->t, expected->t) << "ray " << i;
        ASSERT_EQ(got->triangle, expected->triangle) << "ray " << i;
        ++hits;
    }
    EXPECT_GT(hits, ray_count * 9 / 10);
}
} // namespace

TEST(BuildBvh, FindsTheSameHitsAsBruteForce)
{
    const WorldMesh mesh = randomMesh(3000);
    const Bvh bvh = build(mesh);
    expectSound(bvh, mesh);
    EXPECT_GT(bvh.triangles.size(), mesh.triangles.size()) << "no spatial split was made";
    expectSameHits(bvh, mesh, 4000);
}

TEST(BuildBvh, NeverMissesFlatAxisAlignedGeometry)
{
    const WorldMesh mesh = flatMesh();
    const Bvh bvh = build(mesh);
    expectSound(bvh, mesh);
    expectSameHits(bvh, mesh, 20000);
}

TEST(BuildBvh, HoldsASingleTriangle)
{
    WorldMesh mesh;
    addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Bvh bvh = build(mesh);
    expectSound(bvh, mesh);
    EXPECT_EQ(bvh.nodes.size(), 1u);
    EXPECT_EQ(bvh.depth, 1u);
    EXPECT_EQ(bvh.traversal_stack, 0u);
    expectSameHits(bvh, mesh, 100);
}

TEST(BuildBvh, HoldsManyCopiesOfOneTriangle)
{
    WorldMesh mesh;
    for (int i = 0; i < 1000; ++i)
        addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const Bvh bvh = build(mesh);
    expectSound(bvh, mesh);
    expectSameHits(bvh, mesh, 100);
}

TEST(BuildBvh, FitsTheTraversalStackWhereScalesNestWithoutEnd)
{
    WorldMesh mesh; // each triangle a little smaller and nearer to the origin: the surface-area heuristic makes a chain
    for (int i = 0; i < 4000; ++i)
    {
        const float s = std::pow(0.98f, float(i));
        addTriangle(mesh, {s, 0, 0}, {0, s, 0}, {0, 0, s});
    }
    const Bvh bvh = build(mesh);
    expectSound(bvh, mesh);
    expectSameHits(bvh, mesh, 100);
}

TEST(BuildBvh, GivesEqualBytesForEqualInput)
{
    const WorldMesh mesh = randomMesh(20000); // enough for Embree to use all its threads
    const Bvh first = build(mesh);
    for (int i = 0; i < 5; ++i)
    {
        const Bvh again = build(mesh);
        ASSERT_EQ(again.nodes.size(), first.nodes.size());
        ASSERT_EQ(again.triangles.size(), first.triangles.size());
        EXPECT_EQ(std::memcmp(again.nodes.data(), first.nodes.data(), first.nodes.size() * sizeof(gpu::BvhNode)), 0);
        EXPECT_EQ(std::memcmp(again.triangles.data(), first.triangles.data(),
                              first.triangles.size() * sizeof(gpu::BvhTriangle)),
                  0);
    }
}

/// Long thin triangles every which way: their boxes are nearly empty.
WorldMesh crossingSticks(uint32_t count)
{
    std::mt19937 random(17);
    std::uniform_real_distribution<float> place(-1, 1);
    WorldMesh mesh;
    for (uint32_t i = 0; i < count; ++i)
    {
        const gpu::vec3 a{place(random), place(random), place(random)}, b{place(random), place(random), place(random)};
        addTriangle(mesh, a, b, b + gpu::vec3{0.01f, 0, 0});
    }
    return mesh;
}

TEST(BuildBvh, KeepsTriangleFlags)
{
    const WorldMesh mesh = randomMesh(50);
    std::vector<uint32_t> flags;
    for (uint32_t i = 0; i < 50; ++i)
        flags.push_back(i % 4);
    for (const gpu::BvhTriangle& t : buildBvh(mesh, flags).triangles)
        EXPECT_EQ(t.flags, t.triangle % 4);
}

TEST(BuildBvh, StoresTrianglesWithFlagsOnce)
{
    const auto stored = [](uint32_t flag)
    {
        const WorldMesh mesh = crossingSticks(2000);
        std::vector<uint32_t> flags(mesh.triangles.size(), flag);
        return buildBvh(mesh, flags).triangles.size();
    };
    const size_t count = crossingSticks(2000).triangles.size();
    EXPECT_EQ(stored(gpu::kTriangleAlpha), count);
    EXPECT_GT(stored(0), count); // otherwise the scene needs no splits
}

TEST(BuildBvh, StatesTheCostThatItsNodesHave)
{
    const WorldMesh mesh = randomMesh(2000);
    const Bvh bvh = build(mesh);
    const auto area = [](const std::array<gpu::vec3, 2>& b)
    {
        const gpu::vec3 d = b[1] - b[0];
        return double(d.x) * d.y + double(d.y) * d.z + double(d.z) * d.x;
    };
    std::array<gpu::vec3, 2> root = boxes(bvh.nodes[0])[0];
    double cost = 0;
    for (const gpu::BvhNode& node : bvh.nodes)
    {
        for (uint32_t c = 0; c < 4; ++c)
        {
            const uint32_t reference = children(node)[c];
            if (reference == gpu::kNone)
                continue;
            const bool leaf = (reference & gpu::kLeafBit) != 0;
            const double tests = leaf ? (reference >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1 : 1;
            cost += area(boxes(node)[c]) * tests; // an inner child's own visit, or a leaf's triangles
            if (&node == bvh.nodes.data())
                root = {min(root[0], boxes(node)[c][0]), max(root[1], boxes(node)[c][1])};
        }
    }
    EXPECT_NEAR(bvh.sah_cost, 1 + cost / area(root), 1e-4 * bvh.sah_cost);
}
