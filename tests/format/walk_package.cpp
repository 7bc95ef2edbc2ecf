#include "tests/format/walk_package.h"

#include "format/check.h"
#include "format/material.h"
#include "format/pose.h"
#include "format/texture_encoding.h"

#include <algorithm>
#include <array>

namespace
{
template <typename T>
const T& at(std::span<const T> span, uint32_t index)
{
    check(index < span.size(), "{} of {}", index, span.size());
    return span[index];
}

double texel(const package::Package& package, uint32_t texture)
{
    if (texture == gpu::kNone)
        return 0;
    const gpu::TextureRef& ref = at(package.textureRefs(), texture);
    const lumicut::fb::TexturePage& page = *package.meta().texture_pages()->Get(ref.page);
    double sum = ref.u_row.x + ref.v_row.y;
    uint64_t offset = 0;
    for (uint32_t level = 0; level < page.levels(); ++level)
    {
        const uint64_t layer_bytes = package::levelBytes(page.encoding(), std::max(1u, page.width() >> level),
                                                         std::max(1u, page.height() >> level));
        const uint64_t last = offset + layer_bytes * (ref.layer + 1) - 1; // its layer's last byte of this level
        check(last < package.texturePage(ref.page).size(), "byte {}", last);
        sum += double(package.texturePage(ref.page)[last]);
        offset += layer_bytes * page.layers();
    }
    return sum;
}

double lightEmission(const package::Package& package, const gpu::Light& light)
{
    double sum = light.emission.x / light.pmf;
    if (light.kind == gpu::kLightEnvironment)
        return sum + package.environmentMap().back().x + package.environmentTexels().back().probability;
    if (light.triangle != gpu::kNone)
        sum += at(package.vertexAttributes(), at(package.triangles(), light.triangle).vertices.x).uv0.x;
    if (light.material != gpu::kNone)
        sum += texel(package, at(package.materials(), light.material).emissive_texture);
    return sum;
}

double hit(const package::Package& package, uint32_t bvh_triangle)
{
    const gpu::BvhTriangle& t = at(package.bvhTriangles(), bvh_triangle);
    const gpu::Triangle& surface = at(package.triangles(), t.triangle);
    const gpu::Material& m = at(package.materials(), t.material);
    double sum = t.v0.x + t.v1.y + t.v2.z;
    for (const uint32_t v : {surface.vertices.x, surface.vertices.y, surface.vertices.z})
        sum += at(package.vertexAttributes(), v).uv0.x;
    for (const package::MaterialTexture& texture : package::kMaterialTextures)
        sum += texel(package, m.*texture.index);
    if (surface.light != gpu::kNone)
        sum += at(package.lights(), surface.light).pmf;
    return sum;
}

/// Depth-first with the fixed stack that shaders have; children in order or in reverse.
double traverse(const package::Package& package, bool reverse)
{
    std::array<uint32_t, gpu::kTraversalStackSize> stack;
    uint32_t height = 0;
    double sum = 0;
    for (uint32_t current = 0; current != gpu::kNone;)
    {
        uint32_t next = gpu::kNone;
        if ((current & gpu::kLeafBit) != 0)
        {
            const uint32_t count = (current >> gpu::kLeafCountShift & gpu::kLeafCountMask) + 1;
            for (uint32_t i = 0; i < count; ++i)
                sum += hit(package, (current & gpu::kLeafFirstMask) + i);
        }
        else
        {
            const gpu::uvec4 c = at(package.bvhNodes(), current).child;
            std::array<uint32_t, 4> children{c.x, c.y, c.z, c.w};
            if (reverse)
                std::reverse(children.begin(), children.end());
            for (const uint32_t child : children)
            {
                if (child == gpu::kNone)
                    continue;
                if (next != gpu::kNone)
                {
                    check(height < stack.size(), "stack overflow");
                    stack[height++] = next;
                }
                next = child;
            }
        }
        if (next == gpu::kNone && height > 0)
            next = stack[--height];
        current = next;
    }
    return sum;
}
} // namespace

namespace
{
double walkVertex(const package::Package& package, const package::Pose& pose, uint32_t i)
{
    const auto vertices = package.movingVertices();
    const bool last = i + 1 == vertices.size();
    double sum = vertices[i].position.x + vertices[i].normal.y + vertices[i].tangent.w;
    for (uint32_t k = vertices[i].first_influence;
         k < (last ? package.influences().size() : vertices[i + 1].first_influence); ++k)
        sum += at(std::span<const gpu::BoneMatrix>(pose.bones), at(package.influences(), k).bone).x.w;
    for (uint32_t k = vertices[i].first_morph; k < (last ? package.morphOffsets().size() : vertices[i + 1].first_morph);
         ++k)
        sum += at(std::span<const float>(pose.weights), at(package.morphOffsets(), k).weight);
    return sum;
}

/// All that a player reads to draw a pose.
double walkPose(const package::Package& package, const package::Pose& pose)
{
    double sum = 0;
    for (uint32_t i = 0; i < package.movingVertices().size(); ++i)
        sum += walkVertex(package, pose, i);
    for (const package::PosedLight& light : pose.lights)
        sum += at(package.lights(), light.index).pmf + light.light.emission.x;
    for (const package::PosedCamera& camera : pose.cameras)
        sum += package.meta().cameras()->Get(camera.index)->near_plane() + camera.vertical_fov;
    for (const package::PosedMaterial& material : pose.materials)
        sum += at(package.materials(), material.index).alpha + material.material.alpha;
    return sum;
}

double walkMotion(const package::Package& package)
{
    double sum = walkPose(package, package::poseAtRest(package));
    const auto clips = package.motion()->clips()->size();
    for (uint32_t clip = 0; clip < std::min(clips, 4u); ++clip)
        sum +=
            walkPose(package, package::poseAt(package, clip, 0.7 * package.motion()->clips()->Get(clip)->duration()));
    sum += walkPose(package, package::poseAt(package, std::nullopt, 0.5));
    for (const package::MovingRange& object : package.movingRanges())
    {
        for (uint32_t i = 0; i < object.node_count; ++i)
            sum += at(package.bvhNodes(), object.root_node + i).child.x == gpu::kNone;
        for (uint32_t i = 0; i < object.triangle_count; ++i)
        {
            const uint32_t triangle = at(package.bvhTriangles(), object.first_slot + i).triangle;
            check(triangle - object.first_triangle < object.triangle_count, "triangle {}", triangle);
            const gpu::uvec3& v = at(package.triangles(), object.first_triangle + i).vertices;
            for (const uint32_t vertex : {v.x, v.y, v.z})
                check(vertex - object.first_vertex < object.vertex_count, "vertex {}", vertex);
        }
    }
    return sum;
}
} // namespace

double walkPackage(const package::Package& package)
{
    double sum = traverse(package, false) + traverse(package, true);
    if (package.motion() != nullptr)
        sum += walkMotion(package);
    for (const gpu::AliasEntry& entry : package.lightAliases())
        sum += lightEmission(package, at(package.lights(), entry.alias));
    for (const gpu::Light& light : package.lights())
        sum += lightEmission(package, light);
    for (const gpu::vec3& yield : package.lightYields())
        sum += double(yield.x);
    for (const gpu::EnvironmentTexel& entry : package.environmentTexels())
        sum += at(package.environmentTexels(), entry.alias).threshold;
    for (const gpu::CausticTarget& target : package.causticTargets())
        sum += target.radius;
    for (const lumicut::fb::Camera* camera : *package.meta().cameras())
        sum += camera->position()->x() + (camera->name() ? double(camera->name()->size()) : 0);
    for (const flatbuffers::String* name : *package.meta().material_names())
        sum += name->size();
    return sum + double(package.meta().statistics()->triangles());
}
