#include "tests/format/sample_package.h"

#include "format/check.h"
#include "format/material.h"

#include <unistd.h>

#include <fstream>
#include <iterator>

namespace
{
constexpr uint32_t kFourByFour = 4 | 4 << 16; // texels

/// All present children have the node's own box.
package::StoredNode node(std::array<uint8_t, 4> child)
{
    return {.low = {}, .high = {}, .child = child};
}

gpu::Material material(uint32_t flags)
{
    gpu::Material m = package::defaultMaterial();
    m.base_color = {0.5f, 0.5f, 0.5f};
    m.metallic = 0;
    m.flags = flags;
    return m;
}

gpu::Light light(uint32_t kind, float pmf)
{
    return {.p0 = {0, 1, 0},
            .kind = kind,
            .p1 = {0, -1, 0},
            .triangle = gpu::kNone,
            .p2 = {},
            .pmf = pmf,
            .emission = {1, 1, 1},
            .material = gpu::kNone};
}

void fillMeta(lumicut::fb::MetaT& meta)
{
    using namespace lumicut::fb;
    meta.bounds_min = std::make_unique<Vec3>(0.0f, 0.0f, 0.0f);
    meta.bounds_max = std::make_unique<Vec3>(1.0f, 1.0f, 1.0f);
    auto camera = std::make_unique<CameraT>();
    camera->name = "front";
    camera->position = std::make_unique<Vec3>(0.5f, 0.5f, 3.0f);
    camera->forward = std::make_unique<Vec3>(0.0f, 0.0f, -1.0f);
    camera->up = std::make_unique<Vec3>(0.0f, 1.0f, 0.0f);
    camera->vertical_fov = 0.8f;
    meta.cameras.push_back(std::move(camera));
    auto page = std::make_unique<TexturePageT>();
    page->width = page->height = 4;
    page->layers = 2;
    page->levels = 3;
    meta.texture_pages.push_back(std::move(page));
    meta.environment = std::make_unique<EnvironmentT>();
    meta.environment->width = 4;
    meta.environment->height = 2;
    meta.environment->importance_width = 2;
    meta.environment->importance_height = 1;
    meta.environment->average_radiance = std::make_unique<Vec3>(1.0f, 1.0f, 1.0f);
    meta.statistics = std::make_unique<StatisticsT>();
    meta.statistics->triangles = 5;
    meta.provenance = std::make_unique<ProvenanceT>();
    meta.provenance->source = "sample.gltf";
    meta.provenance->copyright = {"CC0"};
    meta.material_names = {"plain", "lamp", "leaf", "glass"};
    meta.has_alpha = true;
    meta.has_thin = true;
}
} // namespace

SamplePackage::SamplePackage()
{
    fillMeta(meta);
    nodes = {node({2, package::kInnerChild, package::kNoChild, package::kNoChild}), node({1, 1, 1, package::kNoChild})};
    leaf_triangles = {0, 1, 2, 3, 4};
    materials = {material(0), material(0), material(gpu::kMaterialAlphaMask), material(gpu::kMaterialThin)};
    materials[1].emission = {2, 2, 2};
    materials[1].emissive_texture = 0;
    materials[2].base_color_texture = 1;
    materials[3].transmission = 1;
    const std::array<uint32_t, 5> material_of{0, 1, 2, 3, 0};
    const std::array<uint32_t, 5> flags_of{0, 0, gpu::kTriangleAlpha, gpu::kTriangleThin, 0};
    for (uint32_t i = 0; i < 5; ++i)
    {
        const float z = float(i) / 5;
        triangles.push_back(
            {{3 * i, 3 * i + 1, 3 * i + 2}, material_of[i] | flags_of[i] << package::kTriangleFlagsShift});
        positions.insert(positions.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
        vertices.insert(vertices.end(), 3, {1, 2, {0, 0}});
        extras.insert(extras.end(), 3, {{1, 1}, {0x3c003c00, 0x3c003c00}});
    }
    texture_refs = {{0, 0, 0, 0, kFourByFour, {1, 0, 0}, {0, 1, 0}},
                    {0, 1, gpu::kSampleUv1, 0, kFourByFour, {1, 0, 0}, {0, 1, 0}}};
    texture_pages = {std::vector<std::byte>((16 + 4 + 1) * 2 * 4, std::byte{0x55})};
    lights = {light(gpu::kLightPoint, 0.25f), light(gpu::kLightTriangle, 0.25f), light(gpu::kLightEnvironment, 0.5f)};
    lights[1].triangle = 1;
    lights[1].material = 1;
    light_aliases = {{0.75f, 2}, {0.75f, 2}, {1, 2}};
    light_yields = {{1, 1, 1}, {0.5f, 0.25f, 0}, {1, 1, 1}};
    environment_map.assign(8, {1, 1, 1, 1});
    environment_texels = {{1, 0, 0.5f}, {1, 1, 0.5f}};
    caustic_targets = {{{0.5f, 0.5f, 0.6f}, 0.7f}};
}

SamplePackage SamplePackage::moving()
{
    namespace fb = lumicut::fb;
    SamplePackage s;
    fb::MotionT& motion = s.motion.emplace();
    for (int i = 0; i < 2; ++i)
    {
        auto node = std::make_unique<fb::MotionNodeT>();
        node->name = i == 0 ? "arm" : "hand";
        node->parent = i - 1;
        node->weight_count = uint32_t(i);
        motion.nodes.push_back(std::move(node));
        auto bone = std::make_unique<fb::BoneT>();
        bone->node = uint32_t(i);
        bone->shown_by = 0;
        motion.bones.push_back(std::move(bone));
    }
    motion.nodes[0]->rotation = std::make_unique<fb::Double4>(0.0, 0.0, 0.0, 1.0);
    motion.bones[1]->bind = std::make_unique<fb::DoubleMatrix>(
        fb::Double4(1.0, 0.0, 0.0, 0.0), fb::Double4(0.0, 1.0, 0.0, 0.0), fb::Double4(0.0, 0.0, 1.0, 0.0));
    motion.weights = {0};
    auto clip = std::make_unique<fb::ClipT>();
    clip->name = "wave";
    clip->duration = 2;
    const auto channel = [&](fb::ChannelTarget target, uint32_t index, fb::Interpolation interpolation,
                             std::vector<float> times, std::vector<float> values)
    {
        auto c = std::make_unique<fb::ChannelT>();
        c->target = target;
        c->index = index;
        c->interpolation = interpolation;
        c->times = std::move(times);
        c->values = std::move(values);
        clip->channels.push_back(std::move(c));
    };
    using enum fb::ChannelTarget;
    constexpr auto Step = fb::Interpolation::Step, Linear = fb::Interpolation::Linear,
                   CubicSpline = fb::Interpolation::CubicSpline;
    channel(Translation, 0, CubicSpline, {0, 2}, {0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0});
    channel(Rotation, 1, Linear, {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
    channel(Weights, 1, Linear, {0, 1}, {0, 1});
    channel(Visibility, 0, Step, {0, 1}, {1, 0});
    channel(LightIntensity, 0, Linear, {0, 1}, {1, 0});
    channel(CameraYfov, 0, Linear, {0, 1}, {0.8f, 0.4f});
    channel(MaterialEmissiveStrength, 1, Linear, {0, 1}, {1, 3});
    motion.clips.push_back(std::move(clip));
    auto light = std::make_unique<fb::MotionLightT>();
    light->color = std::make_unique<fb::Double3>(1.0, 1.0, 1.0);
    light->intensity = 1;
    motion.lights.push_back(std::move(light));
    motion.cameras.push_back(std::make_unique<fb::MotionCameraT>());
    auto material = std::make_unique<fb::MotionMaterialT>();
    material->material = 1;
    material->emissive = std::make_unique<fb::Double3>(2.0, 2.0, 2.0);
    motion.materials.push_back(std::move(material));
    auto object = std::make_unique<fb::MovingObjectT>();
    object->first_triangle = 2;
    object->triangle_count = 3;
    object->caustic_target = 0;
    motion.objects.push_back(std::move(object));
    for (uint32_t v = 6; v < 15; ++v)
    {
        s.moving_vertices.push_back({.position = s.positions[v],
                                     .first_influence = uint32_t(s.influences.size()),
                                     .normal = {0, 0, 1},
                                     .first_morph = uint32_t(s.morph_offsets.size()),
                                     .tangent = {0, 0, 0, 1}});
        s.influences.push_back({v % 2, v == 6 ? 0.5f : 1});
        if (v != 6)
            continue;
        s.influences.push_back({1, 0.5f});
        s.morph_offsets.push_back({{1, 0, 0}, 0, {0, 0, 0}, {0, 0, 0}});
    }
    return s;
}

Result<std::vector<package::WrittenChunk>> SamplePackage::write(const std::filesystem::path& path,
                                                                const package::WriteOptions& options) const
{
    flatbuffers::FlatBufferBuilder builder;
    lumicut::fb::FinishMetaBuffer(builder, lumicut::fb::Meta::Pack(builder, &meta));
    std::vector<package::ChunkSource> chunks{
        {package::kMetaChunk, 0, std::as_bytes(std::span(builder.GetBufferPointer(), builder.GetSize()))},
        {package::kBvhNodesChunk, 0, std::as_bytes(std::span(nodes))},
        {package::kLeafTrianglesChunk, 0, std::as_bytes(std::span(leaf_triangles))},
        {package::kTrianglesChunk, 0, std::as_bytes(std::span(triangles))},
        {package::kPositionsChunk, 0, std::as_bytes(std::span(positions))},
        {package::kVertexAttributesChunk, 0, std::as_bytes(std::span(vertices))},
        {package::kVertexExtrasChunk, 0, std::as_bytes(std::span(extras))},
        {package::kMaterialsChunk, 0, std::as_bytes(std::span(materials))},
        {package::kTextureRefsChunk, 0, std::as_bytes(std::span(texture_refs))},
        {package::kLightsChunk, 0, std::as_bytes(std::span(lights))},
        {package::kLightAliasesChunk, 0, std::as_bytes(std::span(light_aliases))},
        {package::kEnvironmentChunk, 0, std::as_bytes(std::span(environment_map))},
        {package::kEnvironmentTexelsChunk, 0, std::as_bytes(std::span(environment_texels))},
        {package::kCausticTargetsChunk, 0, std::as_bytes(std::span(caustic_targets))}};
    chunks.push_back({package::kLightYieldsChunk, 0, std::as_bytes(std::span(light_yields))});
    flatbuffers::FlatBufferBuilder motion_builder;
    if (motion)
    {
        lumicut::fb::FinishMotionBuffer(motion_builder, lumicut::fb::Motion::Pack(motion_builder, &*motion));
        chunks.push_back({package::kMotionChunk, 0,
                          std::as_bytes(std::span(motion_builder.GetBufferPointer(), motion_builder.GetSize()))});
    }
    chunks.push_back({package::kMovingVerticesChunk, 0, std::as_bytes(std::span(moving_vertices))});
    chunks.push_back({package::kInfluencesChunk, 0, std::as_bytes(std::span(influences))});
    chunks.push_back({package::kMorphOffsetsChunk, 0, std::as_bytes(std::span(morph_offsets))});
    for (uint32_t i = 0; i < texture_pages.size(); ++i)
        chunks.push_back({package::kTexturePageChunk, i, texture_pages[i]});
    return package::write(path, chunks, options);
}

std::vector<std::byte> SamplePackage::bytes(const package::WriteOptions& options) const
{
    const TemporaryFolder folder;
    const auto written = write(folder.path() / "sample.lumi", options);
    check(written, "{}", written.error().message);
    return readFile(folder.path() / "sample.lumi");
}

std::vector<std::byte> readFile(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> chars{std::istreambuf_iterator<char>(file), {}};
    const auto bytes = std::as_bytes(std::span(chars));
    return {bytes.begin(), bytes.end()};
}

TemporaryFolder::TemporaryFolder()
{
    std::string pattern = std::filesystem::temp_directory_path() / "lumicut-test-XXXXXX";
    check(mkdtemp(pattern.data()), "{}", pattern);
    path_ = pattern;
}

TemporaryFolder::~TemporaryFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}
