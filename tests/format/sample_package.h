// A small package that uses every chunk: the ground on which readers are tested.
#pragma once
#include "format/package_read.h"
#include "format/package_write.h"
#include "format/stored_geometry.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

/// The content as plain vectors, free to be spoiled before it is written.
struct SamplePackage
{
    lumicut::fb::MetaT meta;
    std::vector<package::StoredNode> nodes;
    std::vector<uint32_t> leaf_triangles;
    std::vector<package::StoredTriangle> triangles;
    std::vector<gpu::vec3> positions;
    std::vector<package::StoredVertex> vertices;
    std::vector<package::VertexExtras> extras;
    std::vector<gpu::Material> materials;
    std::vector<gpu::TextureRef> texture_refs;
    std::vector<gpu::Light> lights;
    std::vector<gpu::AliasEntry> light_aliases;
    std::vector<gpu::vec3> light_yields;
    std::vector<gpu::EnvironmentTexel> environment_texels;
    std::vector<gpu::vec4> environment_map;
    std::vector<gpu::CausticTarget> caustic_targets;
    std::vector<std::vector<std::byte>> texture_pages;
    std::optional<lumicut::fb::MotionT> motion;
    std::vector<gpu::MovingVertex> moving_vertices;
    std::vector<gpu::Influence> influences;
    std::vector<gpu::MorphOffset> morph_offsets;

    /// Five triangles under two nodes, four materials, two textures, a point, a triangle and an environment light.
    SamplePackage();

    /// The same, of which the second node with the last three triangles moves, and the light, the camera and a material
    /// change: a clip with every interpolation.
    static SamplePackage moving();

    /// Writes it as the compiler would.
    Result<std::vector<package::WrittenChunk>> write(const std::filesystem::path& path,
                                                     const package::WriteOptions& options = {}) const;

    /// The file's bytes.
    std::vector<std::byte> bytes(const package::WriteOptions& options = {}) const;
};

/// The whole file; empty where it cannot be read.
std::vector<std::byte> readFile(const std::filesystem::path& path);

/// A folder of this process's own that goes away with the object.
class TemporaryFolder
{
public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};
