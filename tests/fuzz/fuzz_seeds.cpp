// Writes the packages that the fuzzer starts from into a folder: plain, compressed, and with all that is optional left
// out.
#include "tests/format/sample_package.h"

#include <fmt/format.h>

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
    const bool saved = save(SamplePackage(), folder / "plain.lumi", 0) &&
                       save(SamplePackage(), folder / "compressed.lumi", 3) && save(bare(), folder / "bare.lumi", 0);
    return int(saved ? ExitCode::kOk : ExitCode::kIo);
}
