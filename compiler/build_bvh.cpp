#include "compiler/build_bvh.h"

#include "compiler/bvh_moving.h"
#include "compiler/bvh_tree.h"
#include "compiler/parallel.h"
#include "format/check.h"
#include "format/large_memory.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <new>
#include <type_traits>

namespace
{
/// User data of Embree's callbacks.
struct Source
{
    const WorldMesh& mesh;
    std::span<const uint32_t> flags; // kTriangle*, by triangle
    float padding = 0;               // metres, around every leaf

    std::array<gpu::vec3, 3> corners(uint32_t triangle) const
    {
        const gpu::uvec3& v = mesh.triangles[triangle];
        return {mesh.positions[v.x], mesh.positions[v.y], mesh.positions[v.z]};
    }
    Box box(uint32_t triangle) const
    {
        Box b;
        for (const gpu::vec3& p : corners(triangle))
            b.grow(p);
        return b;
    }
};

Source makeSource(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    float largest = 0;
    for (const gpu::vec3& p : mesh.positions)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    // A slab test works on differences of coordinates, whose rounding error is that of the largest one, and split
    // triangles have corners rounded to it. Boxes grown by twice that error are never missed, however flat or close to
    // zero they are.
    return {mesh, triangle_flags, largest * 2 * std::numeric_limits<float>::epsilon()};
}

Box toBox(const RTCBuildPrimitive& p)
{
    return {{p.lower_x, p.lower_y, p.lower_z}, {p.upper_x, p.upper_y, p.upper_z}};
}

Box padded(const Box& box, const Source& source)
{
    const float p = source.padding;
    return {box.low - gpu::vec3{p, p, p}, box.high + gpu::vec3{p, p, p}};
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

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void* user)
{
    check(count == 1, "leaf of {}", count);
    auto* leaf = new (rtcThreadLocalAlloc(allocator, sizeof(BinaryNode), 16)) BinaryNode;
    leaf->triangle = primitives[0].primID;
    leaf->box = padded(toBox(primitives[0]), *static_cast<const Source*>(user));
    return leaf;
}

void splitPrimitive(const RTCBuildPrimitive* primitive, unsigned dimension, float position, RTCBounds* left,
                    RTCBounds* right, void* user)
{
    Box left_box;
    Box right_box;
    splitTriangleBox(static_cast<const Source*>(user)->corners(primitive->primID), toBox(*primitive), dimension,
                     position, left_box, right_box);
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

/// @param primitives [triangle_count] and more; what is left of it Embree fills with the parts that spatial splits make
void fillPrimitives(const Source& source, RTCBuildPrimitive* primitives)
{
    const size_t count = source.mesh.staticTriangleCount();
    constexpr size_t kBatch = 1 << 16;
    parallelFor((count + kBatch - 1) / kBatch,
                [&](size_t batch)
                {
                    for (size_t i = batch * kBatch; i < std::min(count, (batch + 1) * kBatch); ++i)
                    {
                        const Box b = source.box(uint32_t(i));
                        primitives[i] = {b.low.x, b.low.y, b.low.z, 0, b.high.x, b.high.y, b.high.z, uint32_t(i)};
                    }
                });
}

/// One triangle, or a part of one, in every leaf: collapse() joins leaves where that is cheaper, which costs rays 4 %
/// less than leaving it to Embree.
BinaryNode* buildBinary(RTCBVH bvh, const Source& source)
{
    const size_t count = source.mesh.staticTriangleCount();
    const size_t capacity = 2 * count;
    const auto primitives = std::make_unique_for_overwrite<RTCBuildPrimitive[]>(capacity);
    preferHugePages(primitives.get(), capacity * sizeof(RTCBuildPrimitive));
    fillPrimitives(source, primitives.get());
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = RTC_BUILD_QUALITY_HIGH;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 1024; // never reached; limitDepth() does better than Embree where a tree is too deep
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = 1;
    arguments.bvh = bvh;
    arguments.primitives = primitives.get();
    arguments.primitiveCount = count;
    arguments.primitiveArrayCapacity = capacity;
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = ignoreBounds;
    arguments.createLeaf = createLeaf;
    arguments.splitPrimitive = splitPrimitive;
    arguments.userPtr = const_cast<Source*>(&source);
    return static_cast<BinaryNode*>(rtcBuildBVH(&arguments));
}

/// Shadow rays count a triangle with flags as often as they meet it. (Embree cannot be kept from splitting one.)
class Unsplit
{
public:
    explicit Unsplit(const Source& source) : source_(source), seen_(source.mesh.triangles.size()) {}

    /// The tree with each triangle that has flags in one leaf, whole; null where nothing is left.
    BinaryNode* run(BinaryNode* node)
    {
        if (!node->isLeaf())
        {
            for (BinaryNode*& child : node->children)
                child = run(child);
            if (node->children[0] == nullptr || node->children[1] == nullptr)
                return node->children[0] == nullptr ? node->children[1] : node->children[0];
            return node;
        }
        if (source_.flags[node->triangle] == 0)
            return node;
        if (seen_[node->triangle])
            return nullptr;
        seen_[node->triangle] = true;
        node->box = padded(source_.box(node->triangle), source_);
        return node;
    }

private:
    const Source& source_;
    std::vector<bool> seen_; // by triangle
};
Bvh buildStatic(const Source& source, uint32_t most_stack)
{
    const Device device(rtcNewDevice(fmt::format("threads={}", thread_limit).c_str()));
    check(device, "Embree error {}", int(rtcGetDeviceError(nullptr)));
    const EmbreeBvh memory(rtcNewBVH(device.get()));
    BinaryNode* root = buildBinary(memory.get(), source);
    check(root, "Embree error {}", int(rtcGetDeviceError(device.get())));
    root = Unsplit(source).run(root);
    return collapseToFit(*root, source.mesh, source.flags, most_stack);
}

/// Of a tree of objects, four children a node.
uint32_t stackAbove(size_t object_count)
{
    uint32_t levels = 0;
    for (size_t n = object_count; n > 1; n = (n + 3) / 4)
        ++levels;
    return levels * (gpu::kBvhWidth - 1);
}
} // namespace

Bvh buildBvh(const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    check(!mesh.triangles.empty() && triangle_flags.size() == mesh.triangles.size(), "{} triangles, {} flags",
          mesh.triangles.size(), triangle_flags.size());
    const Source source = makeSource(mesh, triangle_flags);
    if (mesh.moving.empty())
        return buildStatic(source, gpu::kTraversalStackSize);
    const uint32_t most_stack = gpu::kTraversalStackSize - 1; // below the root
    const uint32_t most_of_object = most_stack - stackAbove(mesh.moving.size());
    std::vector<Bvh> objects(mesh.moving.size());
    parallelFor(objects.size(), [&](size_t i)
                { objects[i] = buildObjectBvh(mesh, triangle_flags, i, source.padding, most_of_object); });
    return joinMoving(mesh.staticTriangleCount() == 0 ? Bvh{} : buildStatic(source, most_stack), objects);
}
