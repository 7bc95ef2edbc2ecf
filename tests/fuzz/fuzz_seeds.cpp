// Writes what the fuzzers start from into a folder and those beside it: packages, plain, compressed, and with all that is
// optional left out; KTX2 textures of every kind that is read.
#include "tests/compiler/ktx2_builder.h"
#include "tests/format/sample_package.h"

#include <fmt/format.h>

#include <fstream>

namespace
{
bool save(const SamplePackage& sample, const std::filesystem::path& path, int zstd_level)
{
    const auto written = sample.write(path, {.zstd_level = zstd_level});
    if (!written)
        fmt::print(stderr, "{}: error: {}\n", path.string(), written.error().message);
    return bool(written);
}

SamplePackage bare()
{
    SamplePackage sample;
    sample.lights.clear();
    sample.light_aliases.clear();
    sample.environment_map.clear();
    sample.environment_texels.clear();
    sample.meta.environment.reset();
    sample.caustic_targets.clear();
    sample.triangles[1].light = gpu::kNone;
    return sample;
}

bool saveTextures(const std::filesystem::path& folder)
{
    struct Seed
    {
        uint32_t vk_format;
        size_t level_bytes; // of 5 x 3 texels
    };
    bool saved = true;
    for (const Seed& seed : {Seed{9, 15}, Seed{29, 45}, Seed{43, 60}, Seed{91, 120}, Seed{97, 120}, Seed{109, 240}, Seed{133, 16},
                             Seed{135, 32}, Seed{137, 32}, Seed{139, 16}, Seed{141, 32}, Seed{145, 32}, Seed{0, 32}})
    {
        const std::vector<std::byte> file =
            makeKtx2({.vk_format = seed.vk_format, .width = 5, .height = 3}, std::vector<std::byte>(seed.level_bytes, std::byte{0x42}));
        std::ofstream stream(folder / fmt::format("{}.ktx2", seed.vk_format), std::ios::binary);
        saved &= bool(stream.write(reinterpret_cast<const char*>(file.data()), std::streamsize(file.size())));
    }
    return saved;
}
} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        fmt::print(stderr, "usage: fuzz_seeds FOLDER\n");
        return int(ExitCode::kUsage);
    }
    const std::filesystem::path folder = argv[1];
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const std::filesystem::path textures = folder.string() + "_ktx2";
    std::filesystem::create_directories(textures, error);
    const bool saved = save(SamplePackage(), folder / "plain.lumi", 0) &&
                       save(SamplePackage(), folder / "compressed.lumi", 3) && save(bare(), folder / "bare.lumi", 0) &&
                       saveTextures(textures);
    return int(saved ? ExitCode::kOk : ExitCode::kIo);
}
