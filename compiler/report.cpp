#include "compiler/report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <iterator>

namespace
{
using nlohmann::ordered_json;

std::string chunkLabel(const package::WrittenChunk& chunk)
{
    return chunk.id == package::kTexturePageChunk ? fmt::format("{} {}", package::chunkName(chunk.id), chunk.index)
                                                  : package::chunkName(chunk.id);
}

std::string hashText(uint64_t hash)
{
    return fmt::format("{:016x}", hash);
}

std::array<double, 3> originOf(const lumicut::fb::MetaT& meta)
{
    return meta.origin ? std::array<double, 3>{meta.origin->x(), meta.origin->y(), meta.origin->z()}
                       : std::array<double, 3>{};
}

uint64_t storedBytes(const CompileReport& report)
{
    uint64_t bytes = 0;
    for (const package::WrittenChunk& chunk : report.chunks)
        bytes += chunk.stored_bytes;
    return bytes;
}
} // namespace

std::string summaryText(const CompileReport& report, const CompileOptions& options)
{
    const lumicut::fb::StatisticsT& s = *report.meta.statistics;
    std::string text;
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{}\n", options.output.string());
    fmt::format_to(out, "  triangles  {} ({} degenerate and {} duplicate removed)\n", s.triangles,
                   s.degenerate_triangles, s.duplicate_triangles);
    fmt::format_to(out, "  vertices   {} ({} normals and {} tangents made)\n", s.vertices, s.generated_normals,
                   report.generated_tangents);
    const std::array<double, 3> origin = originOf(report.meta);
    fmt::format_to(out, "  origin     ({}, {}, {}) m, unit {} m\n", origin[0], origin[1], origin[2], report.meta.unit);
    fmt::format_to(out, "  lights     {} point, {} spot, {} directional, {} emissive triangles, {}; {:.4g} W\n",
                   report.point_lights, report.spot_lights, report.directional_lights, s.emissive_triangles,
                   report.meta.environment ? fmt::format("environment {}x{}", report.meta.environment->width,
                                                         report.meta.environment->height)
                                           : "no environment",
                   s.total_light_power);
    fmt::format_to(out, "  cameras    {}:", report.meta.cameras.size());
    for (const auto& camera : report.meta.cameras)
        fmt::format_to(out, " \"{}\"", camera->name);
    fmt::format_to(out, "\n  materials  {}\n  textures   {} images in {} pages\n", report.meta.material_names.size(),
                   report.images, report.meta.texture_pages.size());
    fmt::format_to(out, "  BVH        {} nodes, {} triangles, SAH cost {:.2f}, depth {}, stack {}\n", s.bvh_nodes,
                   s.bvh_triangles, s.bvh_sah_cost, s.bvh_depth, s.traversal_stack);
    fmt::format_to(out, "  bytes      {}:", storedBytes(report));
    for (const package::WrittenChunk& chunk : report.chunks)
        fmt::format_to(out, " {} {}", chunkLabel(chunk), chunk.stored_bytes);
    fmt::format_to(out, "\n  seconds    {:.2f}:", report.total_seconds);
    for (const CompileStage& stage : report.stages)
        fmt::format_to(out, " {} {:.2f}", stage.name, stage.seconds);
    fmt::format_to(out, "\n");
    fmt::format_to(out, "  memory     {} MiB at most, {} threads\n", report.peak_bytes >> 20, report.threads);
    if (options.cache != nullptr)
        fmt::format_to(out, "  cache      {} found, {} made\n", report.cache_hits, report.cache_misses);
    return text;
}

std::string reportJson(const CompileReport& report, const CompileOptions& options)
{
    const lumicut::fb::StatisticsT& s = *report.meta.statistics;
    ordered_json json;
    json["schema"] = "lumicut-compile-report/1";
    json["tool_version"] = LUMICUT_VERSION;
    json["source"] = options.input.filename().string();
    json["package"] = options.output.filename().string();
    json["package_hash"] = hashText(report.package_hash);
    json["options"] = report.meta.provenance->options;
    json["triangles"] = s.triangles;
    json["vertices"] = s.vertices;
    json["origin"] = originOf(report.meta);
    json["unit"] = report.meta.unit;
    json["degenerate_triangles"] = s.degenerate_triangles;
    json["duplicate_triangles"] = s.duplicate_triangles;
    json["generated_normals"] = s.generated_normals;
    json["generated_tangents"] = report.generated_tangents;
    json["dropped_primitives"] = report.dropped_primitives;
    json["lights"] = {{"point", report.point_lights},
                      {"spot", report.spot_lights},
                      {"directional", report.directional_lights},
                      {"emissive_triangles", s.emissive_triangles},
                      {"environment", report.meta.environment != nullptr},
                      {"total_power_w", s.total_light_power}};
    json["cameras"] = ordered_json::array();
    for (const auto& camera : report.meta.cameras)
        json["cameras"].push_back(camera->name);
    json["materials"] = report.meta.material_names.size();
    json["images"] = report.images;
    json["texture_pages"] = ordered_json::array();
    for (const auto& page : report.meta.texture_pages)
        json["texture_pages"].push_back({{"encoding", lumicut::fb::EnumNameTextureEncoding(page->encoding)},
                                         {"srgb", package::isSrgb(page->encoding)},
                                         {"tiled", page->tiled},
                                         {"width", page->width},
                                         {"height", page->height},
                                         {"layers", page->layers},
                                         {"levels", page->levels}});
    json["bvh"] = {{"nodes", s.bvh_nodes},
                   {"triangles", s.bvh_triangles},
                   {"sah_cost", s.bvh_sah_cost},
                   {"depth", s.bvh_depth},
                   {"traversal_stack", s.traversal_stack}};
    json["chunks"] = ordered_json::array();
    for (const package::WrittenChunk& chunk : report.chunks)
        json["chunks"].push_back({{"id", package::chunkName(chunk.id)},
                                  {"index", chunk.index},
                                  {"stored_bytes", chunk.stored_bytes},
                                  {"raw_bytes", chunk.raw_bytes}});
    json["stages"] = ordered_json::array();
    for (const CompileStage& stage : report.stages)
        json["stages"].push_back({{"name", stage.name}, {"seconds", stage.seconds}});
    json["total_seconds"] = report.total_seconds;
    json["threads"] = report.threads;
    json["peak_bytes"] = report.peak_bytes;
    json["cache"] = {{"found", report.cache_hits}, {"made", report.cache_misses}};
    json["inputs"] = ordered_json::array();
    for (const auto& input : report.meta.provenance->inputs)
        json["inputs"].push_back({{"name", input->name}, {"found", input->content != nullptr}});
    json["warnings"] = report.meta.provenance->warnings;
    json["findings"] = ordered_json::array();
    for (const Warning& warning : report.warnings)
        json["findings"].push_back({{"kind", kindName(warning.kind)},
                                    {"pointer", warning.pointer},
                                    {"message", warning.message},
                                    {"stand_in", warning.stand_in},
                                    {"damage", isDamage(warning.kind)}});
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

bool isReportOf(const std::filesystem::path& report, uint64_t package_hash)
{
    std::ifstream stream(report, std::ios::binary);
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    return json.is_object() && json.value("package_hash", nlohmann::json()) == hashText(package_hash);
}
