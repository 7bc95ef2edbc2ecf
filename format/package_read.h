// Opens .lumi packages: maps the file and verifies everything shaders rely on before a byte reaches the GPU.
// This is the security boundary: shaders do not bounds-check. See FORMAT.md, "What a reader verifies".
#pragma once
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"
#include "format/motion_generated.h"
#include "format/moving_range.h"
#include "format/package_generated.h"
#include "format/package_layout.h"
#include "format/result.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace package
{
/// A verified package. Spans and meta() stay valid as long as the Package lives (movable, not copyable).
class Package
{
public:
    /// @return kIo where the file cannot be opened or is no regular file; kInvalid where any byte of it is not as
    ///         FORMAT.md says; kUnsupported for a newer major version or an unknown required chunk
    static Result<Package> open(const std::filesystem::path& path);

    /// The same over bytes in memory (borrowed, 16-byte aligned); for tests and the fuzzer.
    static Result<Package> openBytes(std::span<const std::byte> bytes);

    const lumicut::fb::Meta& meta() const;

    std::span<const gpu::BvhNode> bvhNodes() const;
    std::span<const gpu::BvhTriangle> bvhTriangles() const;
    std::span<const gpu::Triangle> triangles() const;
    std::span<const gpu::VertexAttributes> vertexAttributes() const;
    std::span<const gpu::Material> materials() const;
    std::span<const gpu::TextureRef> textureRefs() const;
    std::span<const gpu::Light> lights() const;
    std::span<const gpu::AliasEntry> lightAliases() const;
    std::span<const gpu::vec3>
    lightYields() const; // by light, or none: what texture and alpha leave of the emission is all
    std::span<const gpu::EnvironmentTexel> environmentTexels() const;
    std::span<const gpu::vec4> environmentMap() const; // RGBA32F, empty without environment
    std::span<const gpu::CausticTarget> causticTargets() const;
    std::span<const std::byte> texturePage(uint32_t page) const;

    const lumicut::fb::Motion* motion() const;                 // null where nothing moves
    std::span<const gpu::MovingVertex> movingVertices() const; // of the vertices from firstMovingVertex() on
    std::span<const gpu::Influence> influences() const;
    std::span<const gpu::MorphOffset> morphOffsets() const;
    std::span<const MovingRange> movingRanges() const; // by motion()->objects()
    /// From these on everything moves, before them nothing does; the sizes of the arrays where no geometry moves. The
    /// root is node 0, whose children may be of both kinds.
    uint32_t firstMovingNode() const;
    uint32_t firstMovingSlot() const; // into bvhTriangles()
    uint32_t firstMovingTriangle() const;
    uint32_t firstMovingVertex() const;

    std::span<const ChunkEntry> chunks() const; // the table, for `lumicut-pkg info`
    uint64_t fileBytes() const;

    Package(Package&&) noexcept;
    Package& operator=(Package&&) noexcept;
    ~Package();

private:
    struct State;
    explicit Package(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};
} // namespace package
