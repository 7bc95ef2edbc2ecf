#include "compiler/build_bvh.h"

#include "compiler/bvh_tree.h"
#include "format/check.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <new>
#include <numeric>
#include <optional>

namespace
{
std::array<gpu::vec3, 3> corners(const WorldMesh& mesh, uint32_t triangle)
{
    const gpu::uvec3& v = mesh.triangles[triangle];
    return {mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]};
}

Box triangleBox(const WorldMesh& mesh, uint32_t triangle)
{
    Box box;
    for (const gpu::vec3& p : corners(mesh, triangle))
        box.grow(p);
    return box;
}

// ---- Embree's builder ----------------------------------------------------------------------------------------------

Box toBox(const RTCBuildPrimitive& p)
{
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

RTCBounds toBounds(const Box& b)
{
    return {b.low.x, b.low.y, b.low.z, 0, b.high.x, b.high.y, b.high.z, 0};
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned, void*)
{
    return new (rtcThreadLocalAlloc(allocator, sizeof(BinaryNode), 16)) BinaryNode;
}

void setChildren(void* node, void** children, unsigned child_count, void*)
{
    check(child_count == 2, "{} children", child_count);
    for (unsigned i = 0; i < 2; ++i)
        static_cast<BinaryNode*>(node)->children[i] = static_cast<BinaryNode*>(children[i]);
}

void ignoreBounds(void*, const RTCBounds**, unsigned, void*) {} // collapse() derives them from the leaves

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void*)
{
    check(count >= 1 && count <= kMaxLeafTriangles, "leaf of {}", count);
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BinaryNode), 16)) BinaryNode;
    for (size_t i = 0; i < count; ++i)
    {
        leaf->triangles[i] = primitives[i].primID;
        leaf->box.grow(toBox(primitives[i]));
    }
    // Two parts of one triangle may meet in a leaf again; the order depends on the builder's threads.
    const auto begin = leaf->triangles.begin();
    std::sort(begin, begin + long(count));
    leaf->triangle_count = uint32_t(std::unique(begin, begin + long(count)) - begin);
    return leaf;
}

void splitPrimitive(const RTCBuildPrimitive* primitive, unsigned dimension, float position, RTCBounds* left,
                    RTCBounds* right, void* user)
{
    const auto* all_corners = static_cast<const std::array<gpu::vec3, 3>*>(user);
    Box left_box;
    Box right_box;
    splitTriangleBox(all_corners[primitive->primID], toBox(*primitive), dimension, position, left_box, right_box);
    *left = toBounds(left_box);
    *right = toBounds(right_box);
}

struct DeviceRelease
{
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct BvhRelease
{
    void operator()(RTCBVH bvh) const { rtcReleaseBVH(bvh); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using EmbreeBvh = std::unique_ptr<std::remove_pointer_t<RTCBVH>, BvhRelease>;

std::vector<RTCBuildPrimitive> buildPrimitives(const WorldMesh& mesh, size_t capacity)
{
    std::vector<RTCBuildPrimitive> primitives(capacity);
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
    {
        const Box b = triangleBox(mesh, i);
        primitives[i] = {b.low.x, b.low.y, b.low.z, 0, b.high.x, b.high.y, b.high.z, i};
    }
    return primitives;
}

struct BuildChoice
{
    bool spatial_splits;
    uint32_t max_depth;
};

/// @return nothing where Embree gives up (depth limit, memory)
std::optional<Bvh> buildWithEmbree(RTCDevice device, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags,
                                   const BuildChoice& choice, float padding)
{
    const EmbreeBvh bvh(rtcNewBVH(device));
    // Room for as many more as there are triangles: the parts that spatial splits make.
    std::vector<RTCBuildPrimitive> primitives =
        buildPrimitives(mesh, choice.spatial_splits ? 2 * mesh.triangles.size() : mesh.triangles.size());

    std::vector<std::array<gpu::vec3, 3>> all_corners; // gathered once: splitPrimitive() asks for them all the time
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i)
        all_corners.push_back(corners(mesh, i));

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = choice.spatial_splits ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = choice.max_depth;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1; // collapse() joins leaves where that is cheaper: 4 % less cost than leaving it to Embree
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = mesh.triangles.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = ignoreBounds;
    arguments.createLeaf = createLeaf;
    arguments.splitPrimitive = choice.spatial_splits ? splitPrimitive : nullptr;
    arguments.userPtr = all_corners.data();

    auto* root = static_cast<BinaryNode*>(rtcBuildBVH(&arguments));
    if (!root)
        return std::nullopt;
    return collapse(*root, mesh, triangle_flags, padding);
}

// ---- The last resort: halves along the longest side, as shallow as a tree can be ------------------------------------

BinaryNode* buildMedian(const WorldMesh& mesh, std::span<uint32_t> triangles, std::deque<BinaryNode>& nodes)
{
    BinaryNode& node = nodes.emplace_back();
    Box centers;
    const auto center = [&](uint32_t triangle)
    {
        const Box b = triangleBox(mesh, triangle);
        return b.low * 0.5f + b.high * 0.5f;
    };
    if (triangles.size() <= kMaxLeafTriangles)
    {
        std::sort(triangles.begin(), triangles.end());
        std::copy(triangles.begin(), triangles.end(), node.triangles.begin());
        node.triangle_count = uint32_t(triangles.size());
        for (const uint32_t triangle : triangles)
            node.box.grow(triangleBox(mesh, triangle));
        return &node;
    }
    for (const uint32_t triangle : triangles)
        centers.grow(center(triangle));
    const gpu::vec3 size = centers.high - centers.low;
    const auto coordinate = [&](const gpu::vec3& p) {
        return size.x >= size.y && size.x >= size.z ? p.x : size.y >= size.z ? p.y : p.z;
    };
    const auto before = [&](uint32_t a, uint32_t b)
    { return std::pair(coordinate(center(a)), a) < std::pair(coordinate(center(b)), b); };
    const size_t half = triangles.size() / 2;
    std::nth_element(triangles.begin(), triangles.begin() + long(half), triangles.end(), before);
    node.children = {buildMedian(mesh, triangles.first(half), nodes),
                     buildMedian(mesh, triangles.subspan(half), nodes)};
    return &node;
}
} // namespace

Bvh buildBvh(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    check(!mesh.triangles.empty() && triangle_flags.size() == mesh.triangles.size(), "{} triangles, {} flags",
          mesh.triangles.size(), triangle_flags.size());

    // A slab test works on differences of coordinates, whose rounding error is that of the largest one, and split
    // triangles have corners rounded to it. Boxes grown by twice that error are never missed, however flat or close to
    // zero they are.
    float largest = 0;
    for (const gpu::vec3& p : mesh.positions)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const float padding = largest * 2 * std::numeric_limits<float>::epsilon();

    const Device device(rtcNewDevice(nullptr));
    check(device, "Embree error {}", int(rtcGetDeviceError(nullptr)));
    for (const BuildChoice& choice : {BuildChoice{true, 64}, {true, 32}, {false, 64}, {false, 32}})
    {
        std::optional<Bvh> bvh = buildWithEmbree(device.get(), mesh, triangle_flags, choice, padding);
        if (bvh && bvh->traversal_stack <= gpu::kTraversalStackSize)
            return std::move(*bvh);
    }
    std::vector<uint32_t> triangles(mesh.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0u);
    std::deque<BinaryNode> nodes;
    return collapse(*buildMedian(mesh, triangles, nodes), mesh, triangle_flags, padding);
}
