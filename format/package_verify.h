// What a package's chunks must hold before shaders may index by them. FORMAT.md, "What a reader verifies", lists it.
#pragma once
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"
#include "format/motion_generated.h"
#include "format/moving_range.h"
#include "format/package_container.h"
#include "format/package_generated.h"
#include "format/result.h"
#include "format/stored_geometry.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <vector>

namespace package
{
/// Geometry as it lies in the file.
struct StoredArrays
{
    std::span<const StoredNode> nodes;
    std::span<const uint32_t> leaf_triangles;
    std::span<const StoredTriangle> triangles;
    std::span<const gpu::vec3> positions;
    std::span<const StoredVertex> vertices; // as many as positions
    std::span<const VertexExtras> extras;   // as many, or none
};

/// The chunks of a package under their types. The spans refer into the file or the container's storage, those of geometry
/// but for `stored` to an UnfoldedGeometry.
struct Contents
{
    const lumicut::fb::Meta* meta = nullptr;
    StoredArrays stored;
    std::span<const gpu::BvhNode> bvh_nodes;
    std::span<const gpu::BvhTriangle> bvh_triangles;
    std::span<const gpu::Triangle> triangles;
    std::span<const gpu::VertexAttributes> vertex_attributes;
    std::span<const gpu::Material> materials;
    std::span<const gpu::TextureRef> texture_refs;
    std::span<const gpu::Light> lights;
    std::span<const gpu::AliasEntry> light_aliases;
    std::span<const gpu::vec3> light_yields; // as many as lights, or none
    std::span<const gpu::EnvironmentTexel> environment_texels;
    std::span<const gpu::vec4> environment_map;
    std::span<const gpu::CausticTarget> caustic_targets;
    std::array<std::span<const std::byte>, gpu::kTexturePageCount> texture_pages;
    const lumicut::fb::Motion* motion = nullptr; // null: nothing moves
    std::span<const gpu::MovingVertex> moving_vertices;
    std::span<const gpu::Influence> influences;
    std::span<const gpu::MorphOffset> morph_offsets;
};

/// Gives every chunk its type: the FlatBuffer is verified, sizes are whole multiples, what must be there is there.
Result<Contents> readContents(const Container& container);

struct UnfoldedGeometry;
/// Fills `geometry`, which was made for `contents`, and verifies everything in `contents` that anybody indexes or divides by.
/// Fills `moving`, too.
Status verifyContents(const Contents& contents, UnfoldedGeometry& geometry, MovingGeometry& moving, bool parallel);

// The parts of verifyContents(); those of geometry are in unfold_geometry.h.
Status verifyMeta(const Contents& contents);
Status verifyMaterials(const Contents& contents);
Status verifyTextureRefs(const Contents& contents);
Status verifyLights(const Contents& contents);
Status verifyEnvironment(const Contents& contents);
Status verifyCausticTargets(const Contents& contents);
Status verifyMotion(const Contents& contents);         // nodes, bones, clips and what they set
Status verifyMovingVertices(const Contents& contents); // needs the former
/// Finds what moves among the unfolded geometry, which must be verified.
Status findMovingGeometry(const Contents& contents, MovingGeometry& moving);

/// kInvalid with a formatted sentence.
template <typename... Args>
Error invalid(fmt::format_string<Args...> format, Args&&... args)
{
    return {ExitCode::kInvalid, fmt::format(format, std::forward<Args>(args)...)};
}

inline bool isFinite(std::initializer_list<float> values)
{
    for (const float value : values)
    {
        if (!std::isfinite(value))
            return false;
    }
    return true;
}
inline bool isFinite(const gpu::vec3& v)
{
    return isFinite({v.x, v.y, v.z});
}
inline bool isNonNegative(const gpu::vec3& v)
{
    return isFinite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0;
}
inline bool isWithin(float value, float low, float high)
{
    return value >= low && value <= high;
} // false for NaN
inline bool isWithin(const gpu::vec3& v, float low, float high)
{
    return isWithin(v.x, low, high) && isWithin(v.y, low, high) && isWithin(v.z, low, high);
}
inline bool isFinite(const gpu::vec4& v)
{
    return isFinite({v.x, v.y, v.z, v.w});
}
inline float dot(const gpu::vec3& a, const gpu::vec3& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline bool isUnit(const gpu::vec3& v)
{
    return isFinite(v) && std::abs(dot(v, v) - 1) <= 2e-3f;
}
} // namespace package
