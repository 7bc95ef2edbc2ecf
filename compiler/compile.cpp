#include "compiler/compile.h"

#include "compiler/build_bvh.h"
#include "compiler/build_lights.h"
#include "compiler/cached_bvh.h"
#include "compiler/camera_views.h"
#include "compiler/environment.h"
#include "compiler/environment_map.h"
#include "compiler/flatten.h"
#include "compiler/gltf_material.h"
#include "compiler/import_gltf.h"
#include "compiler/light_need.h"
#include "compiler/package_meta.h"
#include "compiler/parallel.h"
#include "compiler/texture_pages.h"
#include "compiler/up_to_date.h"
#include "compiler/world_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>

#include <sys/resource.h>
#include <unistd.h>

namespace
{
/// Times the stages and reports the end of each.
class Stopwatch
{
public:
    Stopwatch(const CompileOptions& options, std::vector<CompileStage>& stages) : options_(options), stages_(stages) {}

    void stage(const char* name, const std::string& outcome)
    {
        const double now = total();
        stages_.push_back({name, now - last_});
        last_ = now;
        if (options_.progress)
            options_.progress(now, fmt::format("{}: {}", name, outcome));
    }
    double total() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    const CompileOptions& options_;
    std::vector<CompileStage>& stages_;
    Clock::time_point start_ = Clock::now();
    double last_ = 0;
};

/// Adds the options' views, which are in the file's coordinates, and converts everything to the package's.
Status placeScene(const CompileOptions& options, ImportedScene& imported)
{
    std::vector<CameraView>& cameras = imported.scene.cameras;
    cameras.insert(cameras.begin(), options.views.begin(), options.views.end());
    if (imported.scene.motion)
        for (const auto& camera : imported.scene.motion->tables.cameras)
            camera->camera += uint32_t(options.views.size());
    return moveIntoFrame(imported, chooseFrame(imported));
}

Status addViewsAndLights(const CompileOptions& options, SceneData& scene)
{
    if (scene.cameras.empty())
        scene.cameras.push_back(defaultView(bounds(scene.mesh)));
    if (options.sun)
        scene.lights.push_back(*options.sun);
    if (!options.environment)
        return Success{};
    Result<LoadedEnvironment> environment = loadEnvironment(*options.environment, options.environment_scale);
    if (!environment)
        return environment.error();
    scene.environment = std::move(environment->image);
    scene.environment->rotation = options.environment_rotation;
    scene.warnings.insert(scene.warnings.end(), environment->warnings.begin(), environment->warnings.end());
    return Success{};
}

LightTables lightsOrDefault(const CompileOptions& options, const Bvh& bvh, SceneData& scene)
{
    LightTables lights = buildLights(scene);
    const bool chosen = options.environment || options.sun; // light from the command line
    const LightNeed need = judgeLight(scene, bvh, lights);
    const bool add = options.default_light == DefaultLight::kOn ||
                     (options.default_light == DefaultLight::kAuto && !chosen && need.dark);
    if (need.dark || need.dim || add)
        scene.warnings.push_back({WarningKind::kDefaultLight, "", need.sentence,
                                  add ? "it gets the default sky and sun (--default-light off leaves them out)"
                                  : need.dark
                                      ? "every picture of it will be black (--default-light on adds a sky and a sun)"
                                      : "pictures of it will be dark (--default-light on adds a sky and a sun)"});
    if (!add)
        return lights;
    if (!scene.environment)
        scene.environment = defaultSky();
    scene.lights.push_back(defaultSun());
    return buildLights(scene);
}

/// The error that damaged items are under --strict, or where nothing else is left.
Error damageError(const Warnings& damage, std::string message)
{
    Error error{ExitCode::kInvalid, std::move(message)};
    for (Warning warning : damage)
    {
        warning.stand_in.clear(); // nothing stands in where there is no package
        error.details.push_back(sentence(warning));
        if (warning.code == ExitCode::kIo && warning.pointer.starts_with("/buffers/"))
            error.code = ExitCode::kIo;
    }
    return error;
}

/// Alpha only where a triangle's coverage can be below 1: by its material or its vertices' colours.
std::vector<uint32_t> triangleFlags(const SceneData& scene)
{
    const std::vector<uint32_t> by_material = materialTriangleFlags(scene);
    constexpr uint32_t kOpaque = 0x3c00; // 1 as a half
    std::vector<uint32_t> flags(scene.mesh.triangles.size());
    for (size_t i = 0; i < flags.size(); ++i)
    {
        const uint32_t material = scene.mesh.materials[i];
        const gpu::uvec3 t = scene.mesh.triangles[i];
        flags[i] = by_material[material];
        if ((scene.materials[material].flags & (gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend)) != 0)
            for (const uint32_t v : {t.x, t.y, t.z})
                if (scene.mesh.attributes[v].color.y >> 16 != kOpaque)
                    flags[i] |= gpu::kTriangleAlpha;
    }
    return flags;
}

template <typename T>
void addChunk(std::vector<package::ChunkSource>& chunks, uint32_t id, const std::vector<T>& data, uint32_t index = 0)
{
    if (!data.empty())
        chunks.push_back({id, index, std::as_bytes(std::span(data))});
}

Result<std::vector<package::WrittenChunk>>
writePackage(const CompileOptions& options, const SceneData& scene, const Bvh& bvh, const LightTables& lights,
             const TexturePages& textures, const EnvironmentImportance* importance, const lumicut::fb::MetaT& meta)
{
    const std::vector<uint8_t> meta_bytes = encodeMeta(meta);
    std::vector<uint8_t> motion_bytes;
    const package::StoredGeometry geometry = foldGeometry(scene.mesh, bvh);
    std::vector<package::ChunkSource> chunks = geometry.chunks();
    addChunk(chunks, package::kMetaChunk, meta_bytes);
    addChunk(chunks, package::kMaterialsChunk, scene.materials);
    addChunk(chunks, package::kTextureRefsChunk, textures.refs);
    for (uint32_t page = 0; page < textures.pages.size(); ++page)
        addChunk(chunks, package::kTexturePageChunk, textures.pages[page].texels, page);
    addChunk(chunks, package::kLightsChunk, lights.lights);
    addChunk(chunks, package::kLightAliasesChunk, lights.aliases);
    addChunk(chunks, package::kLightYieldsChunk, lights.yields);
    addChunk(chunks, package::kCausticTargetsChunk, lights.caustic_targets);
    if (const MotionData* const motion = scene.motion.get())
    {
        Result<std::vector<uint8_t>> encoded = encodeMotion(scene, lights);
        if (!encoded)
            return encoded.error();
        motion_bytes = std::move(*encoded);
        addChunk(chunks, package::kMotionChunk, motion_bytes);
        addChunk(chunks, package::kMovingVerticesChunk, motion->vertices);
        addChunk(chunks, package::kInfluencesChunk, motion->influences);
        addChunk(chunks, package::kMorphOffsetsChunk, motion->morph_offsets);
    }
    if (importance != nullptr)
    {
        addChunk(chunks, package::kEnvironmentChunk, scene.environment->texels);
        addChunk(chunks, package::kEnvironmentTexelsChunk, importance->texels);
    }
    std::sort(chunks.begin(), chunks.end(),
              [](const auto& a, const auto& b) { return a.id != b.id ? a.id < b.id : a.index < b.index; });
    return package::write(options.output, chunks, {options.zstd_level});
}

uint64_t peakBytes()
{
    rusage usage = {};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024;
}

void summarize(const CompileOptions& options, const SceneData& scene, CompileReport& report)
{
    if (options.cache != nullptr)
    {
        report.cache_hits = options.cache->hits();
        report.cache_misses = options.cache->misses();
    }
    report.threads = thread_limit;
    report.peak_bytes = peakBytes();
    report.package_hash = packageHash(options.output);
    for (const PunctualLight& light : scene.lights)
        ++(light.kind == gpu::kLightPoint  ? report.point_lights
           : light.kind == gpu::kLightSpot ? report.spot_lights
                                           : report.directional_lights);
    report.images = uint32_t(scene.images.size());
    report.generated_tangents = scene.counts.generated_tangents;
    report.dropped_primitives = scene.counts.dropped_primitives;
}

Result<CompileReport> runPipeline(const CompileOptions& options)
{
    const Cache closed;
    const Cache& cache = options.cache != nullptr ? *options.cache : closed;
    CompileReport report;
    Stopwatch watch(options, report.stages);

    Result<GltfFile> file = readGltf(options.input);
    if (!file)
        return file.error();
    if (options.time)
        if (const Status status = bakePose(*options.time, *file); !status)
            return status.error();
    watch.stage("read", fmt::format("{} meshes, {} materials, {} images", file->model.meshes.size(),
                                    file->model.materials.size(), file->images.size()));

    Result<ImportedScene> imported = importScene(*file, {options.scene, options.variant});
    if (!imported)
        return imported.error();
    SceneData& scene = imported->scene;
    if (const Status status = placeScene(options, *imported); !status)
        return status.error();
    watch.stage("geometry",
                fmt::format("{} primitives, {} objects", imported->primitives.size(), imported->instances.size()));

    Result<std::vector<DecodedImage>> images = decodeImages(*file, imported->images);
    if (!images)
        return images.error();
    takeImages(std::move(*images), scene);
    watch.stage("images", fmt::format("{} decoded", scene.images.size()));

    Result<WorldMesh> mesh = flatten(*imported, scene.counts, scene.warnings);
    if (!mesh)
    {
        const Warnings damage = damageAmong(scene.warnings);
        return damage.empty() ? mesh.error() : damageError(damage, mesh.error().message);
    }
    scene.mesh = std::move(*mesh);
    imported->primitives = {};
    watch.stage("mesh",
                fmt::format("{} triangles, {} vertices", scene.mesh.triangles.size(), scene.mesh.positions.size()));

    // Before it is read: where it changes meanwhile, the next run finds another content than this.
    std::optional<ContentHash> environment_content;
    if (options.environment)
        environment_content = contentOf(*options.environment);
    if (const Status status = addViewsAndLights(options, scene); !status)
        return status.error();
    const Bvh bvh = cachedBvh(cache, scene.mesh, triangleFlags(scene));
    watch.stage("bvh", fmt::format("{} nodes, SAH cost {:.1f}, depth {}", bvh.nodes.size(), bvh.sah_cost, bvh.depth));

    const LightTables lights = lightsOrDefault(options, bvh, scene);
    std::optional<EnvironmentImportance> importance;
    if (scene.environment)
        importance = buildImportance(*scene.environment);
    const EnvironmentImportance* const sky = importance ? &*importance : nullptr;
    watch.stage("lights",
                fmt::format("{} lights, {} caustic targets", lights.lights.size(), lights.caustic_targets.size()));

    const TexturePages textures =
        buildTexturePages(scene.images, scene.texture_uses, scene.materials, options.textures, cache);
    if (textures.halved > 0)
        scene.warnings.push_back({WarningKind::kApproximated, "",
                                  fmt::format("{} very large images were halved so that {} texture pages suffice",
                                              textures.halved, gpu::kTexturePageCount),
                                  ""});
    watch.stage("textures", fmt::format("{} images, {} pages", scene.images.size(), textures.pages.size()));

    if (const Warnings damage = damageAmong(scene.warnings); options.strict && !damage.empty())
        return damageError(damage,
                           fmt::format("{} damaged; without --strict the package is made",
                                       damage.size() == 1 ? "an item is" : fmt::format("{} items are", damage.size())));
    report.warnings = scene.warnings;
    report.meta = makeMeta(options, scene, bvh, lights, textures, sky);
    noteInputs(file->files->list(), environment_content, *report.meta.provenance);
    auto chunks = writePackage(options, scene, bvh, lights, textures, sky, report.meta);
    if (!chunks)
        return chunks.error().about(options.output.string());
    report.chunks = std::move(*chunks);
    watch.stage("write", options.output.filename().string());
    summarize(options, scene, report);
    report.total_seconds = watch.total();
    return report;
}
} // namespace

Result<CompileReport> compile(const CompileOptions& options)
{
    if (const Status status = checkPaths(options); !status)
        return status.error();
    try
    {
        return runPipeline(options);
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "there is not enough memory to compile this scene"};
    }
    catch (const std::exception& e) // of a third-party library
    {
        return Error{ExitCode::kInvalid, fmt::format("it cannot be read: {}", e.what())};
    }
}

Status checkPaths(const CompileOptions& options)
{
    const auto suffix = [](const std::filesystem::path& path)
    {
        std::string text = path.extension().string();
        std::transform(text.begin(), text.end(), text.begin(),
                       [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
        return text;
    };
    if (suffix(options.input) != ".gltf" && suffix(options.input) != ".glb")
        return Error{ExitCode::kUsage, "the input must be a .gltf or .glb file"};
    if (suffix(options.output) != ".lumi")
        return Error{ExitCode::kUsage, fmt::format("the output \"{}\" must end in .lumi", options.output.string())};
    if (options.environment && suffix(*options.environment) != ".exr" && suffix(*options.environment) != ".hdr")
        return Error{ExitCode::kUsage,
                     fmt::format("the environment \"{}\" must be an .exr or .hdr file", options.environment->string())};
    return checkWritable(options.output);
}

Status checkWritable(const std::filesystem::path& path)
{
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        return Error{ExitCode::kIo, fmt::format("the output \"{}\" is a folder; name a file", path.string())};
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error))
        return Error{ExitCode::kIo,
                     fmt::format("the output folder \"{}\" does not exist; make it first", folder.string())};
    if (access(folder.c_str(), W_OK) != 0)
        return Error{ExitCode::kIo, fmt::format("the output folder \"{}\" cannot be written to", folder.string())};
    return Success{};
}
