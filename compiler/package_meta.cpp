#include "compiler/package_meta.h"

#include "compiler/delta_lobes.h"
#include "compiler/flatten.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace
{
using namespace lumicut;

std::unique_ptr<fb::Vec3> box(gpu::vec3 v)
{
    return std::make_unique<fb::Vec3>(v.x, v.y, v.z);
}

std::unique_ptr<fb::StatisticsT> statistics(const SceneData& scene, const Bvh& bvh, const LightTables& lights)
{
    auto s = std::make_unique<fb::StatisticsT>();
    s->triangles = scene.mesh.triangles.size();
    s->vertices = scene.mesh.positions.size();
    s->bvh_nodes = bvh.nodes.size();
    s->bvh_triangles = bvh.triangles.size();
    s->bvh_sah_cost = bvh.sah_cost;
    s->bvh_depth = bvh.depth;
    s->traversal_stack = bvh.traversal_stack;
    s->degenerate_triangles = scene.counts.degenerate_triangles;
    s->duplicate_triangles = scene.counts.duplicate_triangles;
    s->generated_normals = scene.counts.generated_normals;
    s->punctual_lights = uint32_t(std::count_if(lights.lights.begin(), lights.lights.end(),
                                                [](const gpu::Light& l) { return l.kind <= gpu::kLightDirectional; }));
    s->emissive_triangles = lights.emissive_triangles;
    s->total_light_power = float(std::min(lights.total_power * scene.frame.unit * scene.frame.unit,
                                          double(std::numeric_limits<float>::max()))); // W of the file's metres
    return s;
}

std::unique_ptr<fb::CameraT> camera(const CameraView& view)
{
    auto c = std::make_unique<fb::CameraT>();
    c->name = view.name;
    c->position = box(toFloat(view.position));
    c->forward = box(view.forward);
    c->up = box(view.up);
    c->vertical_fov = view.vertical_fov;
    c->orthographic_height = view.orthographic_height;
    c->near_plane = view.near_plane;
    c->far_plane = view.far_plane;
    return c;
}

std::unique_ptr<fb::TexturePageT> texturePage(const TexturePage& page)
{
    auto p = std::make_unique<fb::TexturePageT>();
    p->encoding = page.encoding;
    p->tiled = page.tiled;
    p->width = page.width;
    p->height = page.height;
    p->layers = page.layers;
    p->levels = page.levels;
    return p;
}
} // namespace

fb::MetaT makeMeta(const CompileOptions& options, const SceneData& scene, const Bvh& bvh, const LightTables& lights,
                   const TexturePages& textures, const EnvironmentImportance* importance)
{
    fb::MetaT meta;
    const Bounds extent = bounds(scene.mesh);
    meta.bounds_min = box(extent.min);
    meta.bounds_max = box(extent.max);
    const WorldFrame& frame = scene.frame;
    if (frame.origin != Vec3d{})
        meta.origin = std::make_unique<fb::Vec3d>(frame.origin.x, frame.origin.y, frame.origin.z);
    meta.unit = frame.unit;
    for (const CameraView& view : scene.cameras)
        meta.cameras.push_back(camera(view));
    for (const TexturePage& page : textures.pages)
        meta.texture_pages.push_back(texturePage(page));
    if (importance != nullptr)
    {
        meta.environment = std::make_unique<fb::EnvironmentT>();
        meta.environment->width = scene.environment->width;
        meta.environment->height = scene.environment->height;
        meta.environment->importance_width = importance->width;
        meta.environment->importance_height = importance->height;
        meta.environment->average_radiance = box(importance->average_radiance);
        meta.environment->rotation = scene.environment->rotation;
    }
    meta.statistics = statistics(scene, bvh, lights);
    meta.provenance = std::make_unique<fb::ProvenanceT>();
    meta.provenance->source = options.input.filename().string();
    meta.provenance->tool_version = LUMICUT_VERSION;
    meta.provenance->options = options.text;
    meta.provenance->generator = scene.generator;
    if (!scene.copyright.empty())
        meta.provenance->copyright.push_back(scene.copyright);
    meta.provenance->warnings = sentences(scene.warnings);
    meta.material_names = scene.material_names;
    const auto any = [&](uint32_t flag)
    {
        return std::any_of(bvh.triangles.begin(), bvh.triangles.end(),
                           [flag](const gpu::BvhTriangle& t) { return (t.flags & flag) != 0; });
    };
    meta.has_alpha = any(gpu::kTriangleAlpha);
    meta.has_thin = any(gpu::kTriangleThin);
    const DeltaLobes delta_lobes = findDeltaLobes(scene);
    meta.has_delta_lobes = delta_lobes.seen;
    meta.has_caustics = delta_lobes.seen && (delta_lobes.matter || !lights.caustic_targets.empty());
    return meta;
}

void noteInputs(const std::vector<InputFile>& files, const std::optional<ContentHash>& environment,
                fb::ProvenanceT& provenance)
{
    const auto content = [](const std::optional<ContentHash>& hash)
    { return hash ? std::make_unique<fb::Hash128>(hash->low, hash->high) : nullptr; };
    provenance.compiler = compilerHash();
    for (const InputFile& file : files)
    {
        auto& input = provenance.inputs.emplace_back(std::make_unique<fb::InputFileT>());
        input->name = file.name;
        input->content = content(file.content);
    }
    provenance.environment_content = content(environment);
}

std::vector<uint8_t> encodeMeta(const fb::MetaT& meta)
{
    flatbuffers::FlatBufferBuilder builder;
    fb::FinishMetaBuffer(builder, fb::Meta::Pack(builder, &meta));
    return {builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize()};
}

Result<std::vector<uint8_t>> encodeMotion(const SceneData& scene, const LightTables& lights)
{
    fb::MotionT tables = fb::MotionT(scene.motion->tables);
    size_t channels = 0;
    for (const auto& clip : tables.clips)
        channels += 1 + clip->channels.size();
    const size_t total = tables.nodes.size() + tables.bones.size() + tables.objects.size() + tables.lights.size() +
                         tables.cameras.size() + tables.materials.size() + channels;
    if (total >= package::kMaxMotionTables)
        return Error{ExitCode::kUnsupported,
                     fmt::format("its animations have {} nodes, joints, channels and objects; at most {} are supported",
                                 total, package::kMaxMotionTables)};
    for (const auto& light : tables.lights)
        light->light = lights.of_punctual[light->light];
    for (const auto& object : tables.objects)
        object->caustic_target = lights.caustic_target_of[scene.mesh.objects[object->first_triangle]];
    flatbuffers::FlatBufferBuilder builder;
    fb::FinishMotionBuffer(builder, fb::Motion::Pack(builder, &tables));
    if (builder.GetSize() > package::kMaxMotionBytes)
        return Error{ExitCode::kUnsupported, fmt::format("its animations take {} bytes; at most {} are supported",
                                                         builder.GetSize(), package::kMaxMotionBytes)};
    return std::vector<uint8_t>(builder.GetBufferPointer(), builder.GetBufferPointer() + builder.GetSize());
}

package::StoredGeometry foldGeometry(const WorldMesh& mesh, const Bvh& bvh)
{
    const Bounds extent = bounds(mesh);
    return package::foldGeometry({.bounds_min = extent.min,
                                  .bounds_max = extent.max,
                                  .nodes = bvh.nodes,
                                  .leaf_triangles = bvh.triangles,
                                  .triangles = mesh.triangles,
                                  .positions = mesh.positions,
                                  .attributes = mesh.attributes});
}
