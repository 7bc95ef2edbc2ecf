// Writes what the fuzz targets start from into a folder for each: packages, pictures, scenes and settings that are
// whole and, between them, cover most features of the readers.
#include "image/write_image.h"
#include "runtime/settings.h"
#include "tests/compiler/ktx2_builder.h"
#include "tests/format/sample_package.h"
#include "tests/image/exr_writer.h"
#include "tests/image/hdr_writer.h"

#include <fmt/format.h>

#include <fstream>

namespace
{
namespace fs = std::filesystem;

bool failed = false;

void save(const fs::path& path, const void* data, size_t size)
{
    std::ofstream file(path, std::ios::binary);
    if (!file.write(static_cast<const char*>(data), std::streamsize(size)).flush())
    {
        fmt::print(stderr, "{}: error: cannot write the seed\n", path.string());
        failed = true;
    }
}

void save(const fs::path& path, const std::vector<std::byte>& bytes)
{
    save(path, bytes.data(), bytes.size());
}

void save(const fs::path& path, const SamplePackage& sample, int zstd_level)
{
    const auto written = sample.write(path, {.zstd_level = zstd_level});
    if (written)
        return;
    fmt::print(stderr, "{}: error: {}\n", path.string(), written.error().message);
    failed = true;
}

/// Plain, compressed, and with all that is optional left out.
void savePackages(const fs::path& folder)
{
    save(folder / "plain.lumi", SamplePackage(), 0);
    save(folder / "compressed.lumi", SamplePackage(), 3);
    save(folder / "moving.lumi", SamplePackage::moving(), 0);
    SamplePackage bare;
    bare.lights.clear();
    bare.light_aliases.clear();
    bare.light_yields.clear();
    bare.environment_map.clear();
    bare.environment_texels.clear();
    bare.meta.environment.reset();
    bare.caustic_targets.clear();
    bare.extras.clear();
    save(folder / "bare.lumi", bare, 0);
}

void saveHdrs(const fs::path& folder)
{
    const ImageF image = exactHdrImage(40, 6, 1);
    save(folder / "flat.hdr", writeHdr(image, {.runs = HdrRuns::kFlat, .magic = "#?RGBE", .orientation = "+Y -X"}));
    save(folder / "old.hdr", writeHdr(image, {.runs = HdrRuns::kOld, .lines = "EXPOSURE=2\nCOLORCORR=1 2 3\n"}));
    save(folder / "new.hdr", writeHdr(image, {.lines = "FORMAT=32-bit_rle_xyze\n# text\n", .orientation = "-X +Y"}));
    save(folder / "primaries.hdr",
         writeHdr(image, {.lines = "PRIMARIES= 0.708 0.292 0.170 0.797 0.131 0.046 0.3127 0.329\n"}));
}

void saveExrs(const fs::path& folder)
{
    const auto value = [](int x, int y) { return float(x % 3) + 0.5f * float(y); };
    const Imath::Box2i box = window(0, 0, 12, 8);
    const ExrPart plain{.data = box, .display = window(2, -3, 12, 20), .channels = rgbChannels(value)};
    save(folder / "plain.exr", writeExr({plain}));
    for (const Imf::Compression compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::PIZ_COMPRESSION,
                                               Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
    {
        ExrPart part = plain;
        part.compression = compression;
        for (ExrChannel& channel : part.channels)
            channel.half = true;
        save(folder / fmt::format("compression{}.exr", int(compression)), writeExr({part}));
    }
    ExrPart tiled = plain;
    tiled.tiles = Imf::TileDescription(5, 4, Imf::RIPMAP_LEVELS);
    tiled.chromaticities = Imf::Chromaticities({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}, {0.3f, 0.3f});
    save(folder / "tiled.exr", writeExr({tiled}));
    const ExrPart chroma{.data = box,
                         .display = box,
                         .channels = {{.name = "a.Y", .value = value},
                                      {.name = "a.RY", .value = value, .sampling = 2},
                                      {.name = "a.BY", .value = value, .sampling = 2}},
                         .name = "second"};
    save(folder / "chroma.exr", writeExr({chroma}));
    ExrPart cube = plain;
    cube.data = cube.display = window(0, 0, 2, 12);
    cube.envmap = Imf::ENVMAP_CUBE;
    save(folder / "cube.exr", writeExr({cube}));
    const ExrPart deep{
        .data = box, .display = box, .channels = {{.name = "Z", .value = value}}, .name = "first", .deep = true};
    save(folder / "parts.exr", writeExr({deep, chroma}));
}

/// A binary glTF file of this JSON, in which %BYTES% stands for the size of `buffer`.
void saveGlb(const fs::path& path, std::string json, const std::string& buffer)
{
    const std::string_view mark = "%BYTES%";
    json.replace(json.find(mark), mark.size(), std::to_string(buffer.size()));
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto word = [](uint32_t value) { return std::string(reinterpret_cast<const char*>(&value), sizeof(value)); };
    const std::string chunks =
        word(uint32_t(json.size())) + "JSON" + json + word(uint32_t(buffer.size())) + std::string("BIN\0", 4) + buffer;
    const std::string file = "glTF" + word(2) + word(uint32_t(12 + chunks.size())) + chunks;
    save(path, file.data(), file.size());
}

/// A triangle with an index, texture coordinates, a sparse accessor, a texture, instances, a light, a camera and
/// extensions.
constexpr const char* kRichScene = R"({
"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"extensionsUsed":["KHR_lights_punctual","KHR_materials_ior","KHR_materials_transmission","EXT_mesh_gpu_instancing"],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":5,"spot":{"outerConeAngle":0.5}}]}},
"nodes":[{"mesh":0,"rotation":[0,0.6,0,0.8],"scale":[1,2,1],"children":[1],
 "extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":3}}}},
 {"camera":0,"extensions":{"KHR_lights_punctual":{"light":0}}}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2,"material":0},{"attributes":{"POSITION":4}}]}],
"materials":[{"alphaMode":"MASK","doubleSided":true,"normalTexture":{"index":0},"emissiveFactor":[1,0.5,0],
 "pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicFactor":0.5},
 "extensions":{"KHR_materials_ior":{"ior":1.4},"KHR_materials_transmission":{"transmissionFactor":0.5}}}],
"textures":[{"source":0,"sampler":0}],"samplers":[{"wrapS":33071,"magFilter":9728}],
"images":[{"bufferView":6,"mimeType":"image/png"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
 {"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},
 {"bufferView":2,"componentType":5123,"count":3,"type":"SCALAR"},
 {"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"},
 {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[9,9,9],"sparse":{"count":2,
  "indices":{"bufferView":4,"componentType":5121},"values":{"bufferView":5}}}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},{"buffer":0,"byteOffset":60,"byteLength":6},
 {"buffer":0,"byteOffset":68,"byteLength":24},{"buffer":0,"byteOffset":92,"byteLength":2},{"buffer":0,"byteOffset":96,"byteLength":24},
 {"buffer":0,"byteOffset":120,"byteLength":%PNG%}],
"buffers":[{"byteLength":%BYTES%}]})";

void saveScenes(const fs::path& folder)
{
    const auto floats = [](const std::vector<float>& values)
    { return std::string(reinterpret_cast<const char*>(values.data()), 4 * values.size()); };
    const std::string triangle = floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    saveGlb(
        folder / "plain.glb",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
        R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":%BYTES%}]})",
        triangle);

    const std::vector<uint8_t> png = encodePng(2, 2, 3, std::vector<uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 9, 9, 9});
    std::string buffer = triangle + floats({0, 1, 1, 1, 0, 0}) + std::string("\0\0\1\0\2\0\0\0", 8) +
                         floats({0, 0, 0, 5, 0, 0}) + std::string("\0\2\0\0", 4) + floats({1, 2, 3, 4, 5, 6});
    buffer.append(png.begin(), png.end());
    buffer.resize((buffer.size() + 3) / 4 * 4);
    std::string json = kRichScene;
    json.replace(json.find("%PNG%"), 5, std::to_string(png.size()));
    saveGlb(folder / "rich.glb", json, buffer);
}

/// Every setting at the ends of its range, and some that are none.
void saveSettings(const fs::path& folder)
{
    for (const char* preset : {"preview", "default", "high"})
    {
        std::string text = preset;
        for (const Setting& setting : allSettings())
            text += fmt::format(
                "\n{}={}\n{}={}", setting.name,
                setting.choices.empty() ? fmt::format("{}", setting.least) : setting.choices.front().name, setting.name,
                setting.choices.empty() ? fmt::format("{}", setting.most) : setting.choices.back().name);
        save(folder / preset, text.data(), text.size());
    }
    const std::string wrong = "default\nphotons.count=-1\nexposure=nan\nexposure=1e999\n=\nterm=\n";
    save(folder / "wrong", wrong.data(), wrong.size());
}

/// Camera paths with every member that a key may have.
void savePaths(const fs::path& folder)
{
    const std::string path =
        R"({"schema": "lumicut-path/1", "keys": [{"time": -1.5, "camera": "hall"}, {"time": 0, "camera": 1},
        {"time": 2, "position": [1, 2, -3e2], "forward": [0, 1, 0], "up": [1, 0, 0], "vertical_fov": 0.7, "near_plane": 0.1,
         "far_plane": 20}, {"time": 2.5, "position": [0, 0, 0], "forward": [-1, 0, 1], "orthographic_height": 3}]})";
    save(folder / "path.json", path.data(), path.size());
    const std::string one = R"({"schema": "lumicut-path/1", "keys": [{"time": 1e9, "camera": 0}]})";
    save(folder / "one.json", one.data(), one.size());
}

/// Textures of every kind that is read.
void saveTextures(const fs::path& folder)
{
    struct Seed
    {
        uint32_t vk_format;
        size_t level_bytes; // of 5 x 3 texels
    };
    for (const Seed& seed :
         {Seed{9, 15}, Seed{29, 45}, Seed{43, 60}, Seed{91, 120}, Seed{97, 120}, Seed{109, 240}, Seed{133, 16},
          Seed{135, 32}, Seed{137, 32}, Seed{139, 16}, Seed{141, 32}, Seed{145, 32}, Seed{0, 32}})
        save(folder / fmt::format("{}.ktx2", seed.vk_format),
             makeKtx2({.vk_format = seed.vk_format, .width = 5, .height = 3},
                      std::vector<std::byte>(seed.level_bytes, std::byte{0x42})));
}
} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        fmt::print(stderr, "usage: fuzz_seeds FOLDER\n");
        return int(ExitCode::kUsage);
    }
    const fs::path folder = argv[1];
    const std::pair<const char*, void (*)(const fs::path&)> kinds[] = {
        {"package", savePackages}, {"hdr", saveHdrs},   {"exr", saveExrs},         {"gltf", saveScenes},
        {"ktx2", saveTextures},    {"path", savePaths}, {"settings", saveSettings}};
    for (const auto& [name, saveAll] : kinds)
    {
        std::error_code error;
        fs::create_directories(folder / name, error);
        saveAll(folder / name);
    }
    return int(failed ? ExitCode::kIo : ExitCode::kOk);
}
