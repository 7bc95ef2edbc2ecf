#include "format/package_verify.h"

#include "format/parallel.h"
#include "format/texture_encoding.h"
#include "format/unfold_geometry.h"

#include <limits>

namespace package
{
namespace
{
enum class Presence
{
    kRequired,
    kOptional
};

template <typename T>
Status readArray(const Container& container, uint32_t id, Presence presence, std::span<const T>& out)
{
    const std::span<const std::byte> bytes = container.find(id);
    if (bytes.empty() && presence == Presence::kRequired)
        return invalid("chunk {} is missing; compile the package again", chunkName(id));
    if (bytes.size() % sizeof(T) != 0)
        return invalid("chunk {}: {} bytes are no whole number of elements of {} bytes", chunkName(id), bytes.size(),
                       sizeof(T));
    const size_t count = bytes.size() / sizeof(T);
    if (count > std::numeric_limits<int32_t>::max())
        return invalid("chunk {}: {} elements, allowed are 2^31 - 1", chunkName(id), count);
    out = {reinterpret_cast<const T*>(bytes.data()), count};
    return Success{};
}

Status readMeta(const Container& container, const lumicut::fb::Meta*& out)
{
    const std::span<const std::byte> bytes = container.find(kMetaChunk);
    if (bytes.empty())
        return invalid("chunk META is missing; compile the package again");
    const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
    if (bytes.size() < 16 || !lumicut::fb::MetaBufferHasIdentifier(data))
        return invalid("chunk META: it is no FlatBuffer with the identifier LUMI");
    flatbuffers::Verifier::Options options;
    options.max_depth = 16;
    options.max_tables = 1u << 16;
    flatbuffers::Verifier verifier(data, bytes.size(), options);
    if (!lumicut::fb::VerifyMetaBuffer(verifier))
        return invalid("chunk META: its FlatBuffer is damaged or lacks a required field");
    out = lumicut::fb::GetMeta(data);
    return Success{};
}

/// Leaves `out` null where there is no such chunk.
Status readMotion(const Container& container, const lumicut::fb::Motion*& out)
{
    const std::span<const std::byte> bytes = container.find(kMotionChunk);
    if (bytes.empty())
        return Success{};
    const auto* data = reinterpret_cast<const uint8_t*>(bytes.data());
    if (bytes.size() < 16 || !lumicut::fb::MotionBufferHasIdentifier(data))
        return invalid("chunk MOTN: it is no FlatBuffer with the identifier MOTN");
    if (bytes.size() > kMaxMotionBytes)
        return invalid("chunk MOTN: it has {} bytes, allowed are {}", bytes.size(), kMaxMotionBytes);
    flatbuffers::Verifier::Options options;
    options.max_depth = 16;
    options.max_tables = kMaxMotionTables;
    flatbuffers::Verifier verifier(data, bytes.size(), options);
    if (!lumicut::fb::VerifyMotionBuffer(verifier))
        return invalid("chunk MOTN: its FlatBuffer is damaged or lacks a required field");
    out = lumicut::fb::GetMotion(data);
    return Success{};
}

uint64_t pageBytes(const lumicut::fb::TexturePage& page)
{
    uint64_t bytes = 0;
    for (uint32_t level = 0; level < page.levels(); ++level)
        bytes += levelBytes(page.encoding(), std::max(1u, page.width() >> level), std::max(1u, page.height() >> level));
    return bytes * page.layers();
}

Status verifyPageSize(const lumicut::fb::TexturePage& page, uint32_t index)
{
    constexpr uint32_t kMaxSize = 16384;
    constexpr uint32_t kMaxLayers = 2048;
    if (page.encoding() > lumicut::fb::TextureEncoding::MAX)
        return invalid("chunk META: texture page {} has the unknown encoding {}", index, uint32_t(page.encoding()));
    if (page.width() < 1 || page.width() > kMaxSize || page.height() < 1 || page.height() > kMaxSize)
        return invalid("chunk META: texture page {} is {} x {} texels, allowed are 1 to {}", index, page.width(),
                       page.height(), kMaxSize);
    if (page.layers() < 1 || page.layers() > kMaxLayers)
        return invalid("chunk META: texture page {} has {} layers, allowed are 1 to {}", index, page.layers(),
                       kMaxLayers);
    const uint32_t full_chain = uint32_t(std::bit_width(std::max(page.width(), page.height())));
    if (page.levels() < 1 || page.levels() > full_chain)
        return invalid("chunk META: texture page {} has {} mip levels, allowed are 1 to {}", index, page.levels(),
                       full_chain);
    if (page.tiled() && page.levels() != 1)
        return invalid("chunk META: texture page {} is tiled and has {} mip levels, allowed is 1", index,
                       page.levels());
    return Success{};
}

Status readTexturePages(const Container& container, Contents& contents)
{
    const auto& pages = *contents.meta->texture_pages();
    if (pages.size() > gpu::kTexturePageCount)
        return invalid("chunk META: {} texture pages, allowed are {}", pages.size(), gpu::kTexturePageCount);
    for (const ChunkEntry& entry : container.table)
    {
        if (entry.id == kTexturePageChunk && entry.index >= pages.size())
            return invalid("chunk TEXP {}: META describes only {} texture pages", entry.index, pages.size());
    }
    for (uint32_t i = 0; i < pages.size(); ++i)
    {
        const lumicut::fb::TexturePage& page = *pages.Get(i);
        if (Status size = verifyPageSize(page, i); !size)
            return size;
        contents.texture_pages[i] = container.find(kTexturePageChunk, i);
        if (contents.texture_pages[i].size() != pageBytes(page))
            return invalid("chunk TEXP {}: {} bytes, but {} layers of {} x {} texels with {} levels take {}", i,
                           contents.texture_pages[i].size(), page.layers(), page.width(), page.height(), page.levels(),
                           pageBytes(page));
    }
    return Success{};
}

Status readArrays(const Container& container, Contents& contents)
{
    const auto required = Presence::kRequired;
    const auto optional = Presence::kOptional;
    StoredArrays& stored = contents.stored;
    for (Status status : {readArray(container, kBvhNodesChunk, required, stored.nodes),
                          readArray(container, kLeafTrianglesChunk, required, stored.leaf_triangles),
                          readArray(container, kTrianglesChunk, required, stored.triangles),
                          readArray(container, kPositionsChunk, required, stored.positions),
                          readArray(container, kVertexAttributesChunk, required, stored.vertices),
                          readArray(container, kVertexExtrasChunk, optional, stored.extras),
                          readArray(container, kMaterialsChunk, required, contents.materials),
                          readArray(container, kTextureRefsChunk, optional, contents.texture_refs),
                          readArray(container, kLightsChunk, optional, contents.lights),
                          readArray(container, kLightAliasesChunk, optional, contents.light_aliases),
                          readArray(container, kLightYieldsChunk, optional, contents.light_yields),
                          readArray(container, kEnvironmentChunk, optional, contents.environment_map),
                          readArray(container, kEnvironmentTexelsChunk, optional, contents.environment_texels),
                          readArray(container, kCausticTargetsChunk, optional, contents.caustic_targets),
                          readArray(container, kMovingVerticesChunk, optional, contents.moving_vertices),
                          readArray(container, kInfluencesChunk, optional, contents.influences),
                          readArray(container, kMorphOffsetsChunk, optional, contents.morph_offsets)})
    {
        if (!status)
            return status;
    }
    if (stored.positions.size() != stored.vertices.size())
        return invalid("chunk VPOS: {} vertices, chunk VATT has {}", stored.positions.size(), stored.vertices.size());
    if (!stored.extras.empty() && stored.extras.size() != stored.vertices.size())
        return invalid("chunk VEXT: {} vertices, chunk VATT has {}", stored.extras.size(), stored.vertices.size());
    return Success{};
}
} // namespace

Result<Contents> readContents(const Container& container)
{
    Contents contents;
    if (Status status = readMeta(container, contents.meta); !status)
        return status.error();
    if (Status status = readArrays(container, contents); !status)
        return status.error();
    if (Status status = readTexturePages(container, contents); !status)
        return status.error();
    if (Status status = readMotion(container, contents.motion); !status)
        return status.error();
    return contents;
}

Status verifyContents(const Contents& contents, UnfoldedGeometry& geometry, MovingGeometry& moving, bool parallel)
{
    if (Status meta = verifyMeta(contents); !meta) // everything refers to its bounds
        return meta;
    std::vector<std::function<Status()>> tasks;
    const auto add = [&](Status (*verify)(const Contents&))
    { tasks.emplace_back([&contents, verify] { return verify(contents); }); };
    geometry.addFirst(contents, tasks);
    for (const auto verify :
         {verifyMaterials, verifyTextureRefs, verifyEnvironment, verifyCausticTargets, verifyMotion})
        add(verify);
    if (Status status = runAll(tasks, parallel); !status)
        return status;
    tasks.clear();
    geometry.addSecond(contents, tasks);
    add(verifyLights);
    add(verifyMovingVertices);
    tasks.emplace_back([&] { return findMovingGeometry(contents, moving); });
    return runAll(tasks, parallel);
}
} // namespace package
