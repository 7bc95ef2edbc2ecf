#include "format/package_read.h"
#include "tools/pkg/commands.h"

#include <nlohmann/json.hpp>

#include <array>
#include <numbers>

namespace
{
using Json = nlohmann::ordered_json;

std::string text(const flatbuffers::String* string)
{
    return string ? string->str() : std::string();
}

Json list(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* strings)
{
    Json json = Json::array();
    for (uint32_t i = 0; strings && i < strings->size(); ++i)
        json.push_back(strings->Get(i)->str());
    return json;
}

Json vec(const lumicut::fb::Vec3* v)
{
    return {v->x(), v->y(), v->z()};
}

/// Metres, of the package's zero in the source's coordinates.
std::array<double, 3> origin(const lumicut::fb::Meta& meta)
{
    const lumicut::fb::Vec3d* const v = meta.origin();
    return v ? std::array<double, 3>{v->x(), v->y(), v->z()} : std::array<double, 3>{};
}

Json cameras(const lumicut::fb::Meta& meta)
{
    Json json = Json::array();
    for (const lumicut::fb::Camera* camera : *meta.cameras())
        json.push_back({{"name", text(camera->name())},
                        {"position", vec(camera->position())},
                        {"forward", vec(camera->forward())},
                        {"up", vec(camera->up())},
                        {"vertical_fov", camera->vertical_fov()},
                        {"orthographic_height", camera->orthographic_height()},
                        {"near_plane", camera->near_plane()},
                        {"far_plane", camera->far_plane()}});
    return json;
}

Json texturePages(const lumicut::fb::Meta& meta)
{
    Json json = Json::array();
    for (const lumicut::fb::TexturePage* page : *meta.texture_pages())
        json.push_back({{"encoding", lumicut::fb::EnumNameTextureEncoding(page->encoding())},
                        {"tiled", page->tiled()},
                        {"width", page->width()},
                        {"height", page->height()},
                        {"layers", page->layers()},
                        {"levels", page->levels()}});
    return json;
}

Json lights(const package::Package& package)
{
    constexpr std::array kNames{"point", "spot", "directional", "triangle", "triangle_two_sided", "environment"};
    Json json = Json::object();
    for (const char* name : kNames)
        json[name] = 0;
    for (const gpu::Light& light : package.lights())
        json[kNames[light.kind]] = json[kNames[light.kind]].get<int>() + 1;
    return json;
}

Json chunks(const package::Package& package)
{
    Json json = Json::array();
    for (const package::ChunkEntry& entry : package.chunks())
        json.push_back({{"id", package::chunkName(entry.id)},
                        {"index", entry.index},
                        {"offset", entry.offset},
                        {"stored_bytes", entry.stored_bytes},
                        {"raw_bytes", entry.raw_bytes},
                        {"codec", entry.codec == package::Codec::kZstd ? "zstd" : "none"},
                        {"hash", fmt::format("{:016x}", entry.hash)}});
    return json;
}

Json statistics(const lumicut::fb::Statistics& s)
{
    return {{"triangles", s.triangles()},
            {"vertices", s.vertices()},
            {"bvh_nodes", s.bvh_nodes()},
            {"bvh_triangles", s.bvh_triangles()},
            {"bvh_sah_cost", s.bvh_sah_cost()},
            {"bvh_depth", s.bvh_depth()},
            {"traversal_stack", s.traversal_stack()},
            {"degenerate_triangles", s.degenerate_triangles()},
            {"duplicate_triangles", s.duplicate_triangles()},
            {"generated_normals", s.generated_normals()},
            {"punctual_lights", s.punctual_lights()},
            {"emissive_triangles", s.emissive_triangles()},
            {"total_light_power", s.total_light_power()}};
}

Json provenance(const lumicut::fb::Provenance& p)
{
    return {{"source", text(p.source())},       {"tool_version", text(p.tool_version())},
            {"options", list(p.options())},     {"generator", text(p.generator())},
            {"copyright", list(p.copyright())}, {"warnings", list(p.warnings())}};
}

Json motion(const package::Package& package)
{
    const lumicut::fb::Motion* const m = package.motion();
    if (m == nullptr)
        return nullptr;
    Json clips = Json::array();
    for (const lumicut::fb::Clip* clip : *m->clips())
        clips.push_back(
            {{"name", text(clip->name())}, {"duration", clip->duration()}, {"channels", clip->channels()->size()}});
    return {{"clips", clips},
            {"nodes", m->nodes()->size()},
            {"bones", m->bones()->size()},
            {"objects", m->objects()->size()},
            {"triangles", package.triangles().size() - package.firstMovingTriangle()},
            {"vertices", package.movingVertices().size()},
            {"influences", package.influences().size()},
            {"morph_offsets", package.morphOffsets().size()},
            {"lights", m->lights()->size()},
            {"cameras", m->cameras()->size()}};
}

Json describe(const package::Package& package)
{
    const lumicut::fb::Meta& meta = package.meta();
    Json json{{"file_bytes", package.fileBytes()},
              {"bounds_min", vec(meta.bounds_min())},
              {"bounds_max", vec(meta.bounds_max())},
              {"origin", origin(meta)},
              {"unit", meta.unit()},
              {"triangles", package.triangles().size()},
              {"vertices", package.vertexAttributes().size()},
              {"bvh_nodes", package.bvhNodes().size()},
              {"bvh_triangles", package.bvhTriangles().size()},
              {"materials", list(meta.material_names())},
              {"texture_refs", package.textureRefs().size()},
              {"texture_pages", texturePages(meta)},
              {"lights", lights(package)},
              {"caustic_targets", package.causticTargets().size()},
              {"environment", nullptr},
              {"cameras", cameras(meta)},
              {"motion", motion(package)},
              {"statistics", statistics(*meta.statistics())},
              {"provenance", provenance(*meta.provenance())},
              {"chunks", chunks(package)}};
    if (const lumicut::fb::Environment* e = meta.environment())
        json["environment"] = {{"width", e->width()},
                               {"height", e->height()},
                               {"importance_width", e->importance_width()},
                               {"importance_height", e->importance_height()},
                               {"average_radiance", vec(e->average_radiance())},
                               {"rotation", e->rotation()}};
    return json;
}

std::string joined(const Json& strings)
{
    std::string all;
    for (const Json& string : strings)
        all += (all.empty() ? "" : ", ") + string.get<std::string>();
    return printable(all.empty() ? "-" : all);
}

/// The package's unit of length.
std::string unitOf(const lumicut::fb::Meta& meta)
{
    return meta.unit() == 1 ? "m" : "units";
}

void printCameras(const lumicut::fb::Meta& meta)
{
    const std::string unit = unitOf(meta);
    for (const lumicut::fb::Camera* camera : *meta.cameras())
    {
        const bool perspective = camera->vertical_fov() > 0;
        fmt::print("camera       \"{}\" at ({:.3g}, {:.3g}, {:.3g}), {}\n", printable(text(camera->name())),
                   camera->position()->x(), camera->position()->y(), camera->position()->z(),
                   perspective ? fmt::format("{:.1f} degrees", double(camera->vertical_fov()) * 180 / std::numbers::pi)
                               : fmt::format("orthographic, {:.3g} {}", camera->orthographic_height(), unit));
    }
}

void printMotion(const package::Package& package)
{
    const Json m = motion(package);
    if (m.is_null())
        return;
    fmt::print("motion       {} objects, {} triangles, {} nodes, {} lights, {} cameras\n", m["objects"].get<size_t>(),
               m["triangles"].get<size_t>(), m["nodes"].get<size_t>(), m["lights"].get<size_t>(),
               m["cameras"].get<size_t>());
    for (const Json& clip : m["clips"])
        fmt::print("animation    \"{}\", {:.4g} s\n", printable(clip["name"].get<std::string>()),
                   clip["duration"].get<double>());
}

void printTables(const package::Package& package)
{
    const lumicut::fb::Meta& meta = package.meta();
    for (const lumicut::fb::TexturePage* page : *meta.texture_pages())
        fmt::print("texture page {} layers of {} x {}, {} levels, {}{}\n", page->layers(), page->width(),
                   page->height(), page->levels(), lumicut::fb::EnumNameTextureEncoding(page->encoding()),
                   page->tiled() ? ", tiles" : "");
    for (const package::ChunkEntry& entry : package.chunks())
        fmt::print("chunk        {} {:<2} {:>12} bytes{}\n", package::chunkName(entry.id), entry.index, entry.raw_bytes,
                   entry.codec == package::Codec::kZstd ? fmt::format(", {} compressed", entry.stored_bytes) : "");
}

void printText(const std::filesystem::path& path, const package::Package& package)
{
    const lumicut::fb::Meta& meta = package.meta();
    const lumicut::fb::Statistics& s = *meta.statistics();
    const lumicut::fb::Provenance& p = *meta.provenance();
    fmt::print("package      {}, {} bytes\n", path.filename().string(), package.fileBytes());
    fmt::print("source       {}, compiled by version {}\n", printable(text(p.source())),
               printable(text(p.tool_version())));
    fmt::print("copyright    {}\n", joined(list(p.copyright())));
    fmt::print("bounds       ({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g}) {}\n", meta.bounds_min()->x(),
               meta.bounds_min()->y(), meta.bounds_min()->z(), meta.bounds_max()->x(), meta.bounds_max()->y(),
               meta.bounds_max()->z(), unitOf(meta));
    const auto [x, y, z] = origin(meta);
    fmt::print("origin       ({}, {}, {}) m in the source, unit {} m\n", x, y, z, meta.unit());
    fmt::print("triangles    {}, {} vertices, {} materials, {} textures\n", package.triangles().size(),
               package.vertexAttributes().size(), package.materials().size(), package.textureRefs().size());
    fmt::print("hierarchy    {} nodes, {} triangles, cost {:.2f}, depth {}, stack {}\n", package.bvhNodes().size(),
               package.bvhTriangles().size(), s.bvh_sah_cost(), s.bvh_depth(), s.traversal_stack());
    std::string kinds;
    const Json counts = lights(package);
    for (const auto& [name, count] : counts.items())
        kinds += count.get<int>() > 0 ? fmt::format(", {} {}", count.get<int>(), name) : "";
    fmt::print("lights       {}{}, {:.4g} W\n", package.lights().size(), kinds, s.total_light_power());
    fmt::print("caustics     {} targets\n", package.causticTargets().size());
    if (const lumicut::fb::Environment* e = meta.environment())
        fmt::print("environment  {} x {}, turned by {:.6g} degrees\n", e->width(), e->height(),
                   e->rotation() * 180 / std::numbers::pi);
    printCameras(meta);
    printMotion(package);
    printTables(package);
    for (const Json& warning : list(p.warnings()))
        fmt::print("warning      {}\n", printable(warning.get<std::string>()));
}
} // namespace

std::string printable(std::string string)
{
    for (char& c : string)
    {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            c = '?';
    }
    return string;
}

ExitCode info(const std::filesystem::path& path, TextFormat format)
{
    const auto package = package::Package::open(path);
    if (!package)
        return report(path, package.error());
    if (format == TextFormat::kText)
        printText(path, *package);
    else // names may be in any encoding; JSON is UTF-8
        fmt::print("{}\n", describe(*package).dump(2, ' ', false, Json::error_handler_t::replace));
    return ExitCode::kOk;
}
