// The compiler's pipeline: one glTF scene in, one package out.
#pragma once
#include "compiler/bake_pose.h"
#include "compiler/cache.h"
#include "compiler/input_files.h"
#include "compiler/scene_data.h"
#include "compiler/texture_pages.h"
#include "format/package_generated.h"
#include "format/package_write.h"
#include "format/result.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

/// Whether a default sky and sun are added to the scene's own light.
enum class DefaultLight
{
    kAuto, // if the picture would be black without them, and the command line adds no light
    kOn,
    kOff,
};

struct CompileOptions
{
    std::filesystem::path input;     // .gltf or .glb
    std::filesystem::path output;    // .lumi
    std::string scene{};             // of the file, name or index; empty: its default
    std::string variant{};           // of KHR_materials_variants; empty: none
    std::optional<BakedTime> time{}; // that the package shows without moving; none: it carries the animations
    std::optional<std::filesystem::path> environment{};
    float environment_rotation = 0; // radians about +Y, -pi to pi
    float environment_scale = 1;    // > 0, of its radiance
    std::optional<PunctualLight> sun{};
    std::vector<CameraView> views{}; // in the file's coordinates; come before its own cameras
    DefaultLight default_light = DefaultLight::kAuto;
    bool strict = false; // damaged items of the scene are an error
    int zstd_level = 0;  // 0: no compression
    TextureCompression textures = TextureCompression::kBlocks;
    std::vector<std::string> text{}; // the options as given, for the package's provenance
    const Cache* cache = nullptr;    // of costly results; null: none
    std::function<void(double seconds, const std::string& line)> progress{}; // after each stage; may be empty
};

struct CompileStage
{
    std::string name;
    double seconds = 0;
};

/// The result: the package's META, and sizes and times that are not part of it.
struct CompileReport
{
    lumicut::fb::MetaT meta;
    Warnings warnings; // each of them; META has their sentences, summed
    uint32_t point_lights = 0;
    uint32_t spot_lights = 0;
    uint32_t directional_lights = 0;
    uint32_t images = 0;
    uint64_t generated_tangents = 0;
    uint64_t dropped_primitives = 0;
    std::vector<package::WrittenChunk> chunks;
    std::vector<CompileStage> stages;
    double total_seconds = 0;
    uint64_t package_hash = 0; // of the header, and by way of it of the whole package
    unsigned threads = 0;      // that were allowed
    uint64_t peak_bytes = 0;   // memory of the whole process so far
    uint32_t cache_hits = 0;
    uint32_t cache_misses = 0;
};

/// Compiles `options.input` and writes `options.output`, all or nothing. Equal input and options give equal bytes.
/// @return the stages' errors; kDevice if memory runs out. Damaged items are in the error's details if nothing is left to
///         draw, and if options.strict makes them the error (kInvalid)
Result<CompileReport> compile(const CompileOptions& options);

/// Checks that need no work: suffixes, and whether the output's folder can be written to.
Status checkPaths(const CompileOptions& options);

/// kIo if a file cannot be created at `path`: it is a folder, or its folder is missing or read-only.
Status checkWritable(const std::filesystem::path& path);
