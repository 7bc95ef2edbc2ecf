#include "compiler/cached_bvh.h"

#include <cstring>

namespace
{
/// Before nodes and triangles in a cached result.
struct Header
{
    uint64_t node_count;
    uint64_t triangle_count;
    float sah_cost;
    uint32_t depth;
    uint32_t traversal_stack;
    uint32_t reserved;
};

template <typename T>
std::span<const std::byte> bytesOf(const std::vector<T>& data)
{
    return std::as_bytes(std::span(data));
}

std::optional<Bvh> decode(std::span<const std::byte> bytes)
{
    Header header;
    if (bytes.size() < sizeof header)
        return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof header);
    if (bytes.size() - sizeof header !=
        header.node_count * sizeof(gpu::BvhNode) + header.triangle_count * sizeof(gpu::BvhTriangle))
        return std::nullopt;
    Bvh bvh{.nodes = std::vector<gpu::BvhNode>(header.node_count),
            .triangles = std::vector<gpu::BvhTriangle>(header.triangle_count),
            .sah_cost = header.sah_cost,
            .depth = header.depth,
            .traversal_stack = header.traversal_stack};
    const std::byte* const nodes = bytes.data() + sizeof header;
    std::memcpy(bvh.nodes.data(), nodes, bytesOf(bvh.nodes).size());
    std::memcpy(bvh.triangles.data(), nodes + bytesOf(bvh.nodes).size(), bytesOf(bvh.triangles).size());
    return bvh;
}
} // namespace

Bvh cachedBvh(const Cache& cache, const WorldMesh& mesh, std::span<const uint32_t> triangle_flags)
{
    if (!cache.isOpen())
        return buildBvh(mesh, triangle_flags);
    const ContentHash key = Hasher("bvh")
                                .array(mesh.positions)
                                .array(mesh.triangles)
                                .array(mesh.materials)
                                .array(mesh.moving)
                                .bytes(std::as_bytes(triangle_flags))
                                .finish();
    if (const auto found = cache.find(key))
        if (std::optional<Bvh> bvh = decode(*found))
            return std::move(*bvh);
    Bvh bvh = buildBvh(mesh, triangle_flags);
    const Header header{bvh.nodes.size(), bvh.triangles.size(), bvh.sah_cost, bvh.depth, bvh.traversal_stack, 0};
    const std::array parts{std::as_bytes(std::span(&header, 1)), bytesOf(bvh.nodes), bytesOf(bvh.triangles)};
    cache.store(key, parts);
    return bvh;
}
