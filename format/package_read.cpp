#include "format/package_read.h"

#include "format/check.h"
#include "format/mapped_file.h"
#include "format/package_container.h"
#include "format/unfold_geometry.h"

#include <new>
#include <optional>

namespace package
{
struct Package::State
{
    MappedFile file; // empty over borrowed bytes
    uint64_t file_bytes = 0;
    Container container;
    Contents contents;
    std::optional<UnfoldedGeometry> geometry;
    MovingGeometry moving;
};

namespace
{
constexpr size_t kParallelBytes = 1u << 20;

/// Fills `state`, which already owns the memory of `bytes`.
template <typename State>
Status read(std::span<const std::byte> bytes, State& state)
{
    try
    {
        Result<Container> container = readContainer(bytes);
        if (!container)
            return container.error();
        state.container = std::move(*container);
        Result<Contents> contents = readContents(state.container);
        if (!contents)
            return contents.error();
        state.contents = *contents;
        state.file_bytes = bytes.size();
        state.geometry.emplace(state.contents);
        return verifyContents(state.contents, *state.geometry, state.moving, bytes.size() >= kParallelBytes);
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "there is not enough memory to open the package; close other programs"};
    }
}
} // namespace

Result<Package> Package::open(const std::filesystem::path& path)
{
    Result<MappedFile> file = MappedFile::open(path);
    if (!file)
        return file.error();
    auto state = std::make_unique<State>();
    state->file = std::move(*file);
    if (Status status = read(state->file.bytes(), *state); !status)
        return status.error();
    return Package(std::move(state));
}

Result<Package> Package::openBytes(std::span<const std::byte> bytes)
{
    check(reinterpret_cast<uintptr_t>(bytes.data()) % kSmallAlignment == 0, "bytes at {}", fmt::ptr(bytes.data()));
    auto state = std::make_unique<State>();
    if (Status status = read(bytes, *state); !status)
        return status.error();
    return Package(std::move(state));
}

Package::Package(std::unique_ptr<State> state) : state_(std::move(state)) {}
Package::Package(Package&&) noexcept = default;
Package& Package::operator=(Package&&) noexcept = default;
Package::~Package() = default;

const lumicut::fb::Meta& Package::meta() const
{
    return *state_->contents.meta;
}
std::span<const gpu::BvhNode> Package::bvhNodes() const
{
    return state_->contents.bvh_nodes;
}
std::span<const gpu::BvhTriangle> Package::bvhTriangles() const
{
    return state_->contents.bvh_triangles;
}
std::span<const gpu::Triangle> Package::triangles() const
{
    return state_->contents.triangles;
}
std::span<const gpu::VertexAttributes> Package::vertexAttributes() const
{
    return state_->contents.vertex_attributes;
}
std::span<const gpu::Material> Package::materials() const
{
    return state_->contents.materials;
}
std::span<const gpu::TextureRef> Package::textureRefs() const
{
    return state_->contents.texture_refs;
}
std::span<const gpu::Light> Package::lights() const
{
    return state_->contents.lights;
}
std::span<const gpu::AliasEntry> Package::lightAliases() const
{
    return state_->contents.light_aliases;
}
std::span<const gpu::vec3> Package::lightYields() const
{
    return state_->contents.light_yields;
}
std::span<const gpu::EnvironmentTexel> Package::environmentTexels() const
{
    return state_->contents.environment_texels;
}
std::span<const gpu::vec4> Package::environmentMap() const
{
    return state_->contents.environment_map;
}
std::span<const gpu::CausticTarget> Package::causticTargets() const
{
    return state_->contents.caustic_targets;
}
const lumicut::fb::Motion* Package::motion() const
{
    return state_->contents.motion;
}
std::span<const gpu::MovingVertex> Package::movingVertices() const
{
    return state_->contents.moving_vertices;
}
std::span<const gpu::Influence> Package::influences() const
{
    return state_->contents.influences;
}
std::span<const gpu::MorphOffset> Package::morphOffsets() const
{
    return state_->contents.morph_offsets;
}
std::span<const MovingRange> Package::movingRanges() const
{
    return state_->moving.objects;
}
uint32_t Package::firstMovingNode() const
{
    return state_->moving.first_node;
}
uint32_t Package::firstMovingSlot() const
{
    return state_->moving.first_slot;
}
uint32_t Package::firstMovingTriangle() const
{
    return state_->moving.first_triangle;
}
uint32_t Package::firstMovingVertex() const
{
    return state_->moving.first_vertex;
}
std::span<const ChunkEntry> Package::chunks() const
{
    return state_->container.table;
}
uint64_t Package::fileBytes() const
{
    return state_->file_bytes;
}

std::span<const std::byte> Package::texturePage(uint32_t page) const
{
    check(page < gpu::kTexturePageCount, "texture page {}", page);
    return state_->contents.texture_pages[page];
}
} // namespace package
