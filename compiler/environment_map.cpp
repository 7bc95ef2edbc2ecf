#include "compiler/environment_map.h"

#include "compiler/cube_map.h"
#include "compiler/environment_sink.h"
#include "format/mapped_file.h"
#include "image/read_exr.h"
#include "image/read_hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace
{
using Reader = Status (*)(std::span<const std::byte>, PictureSink&);

/// Pictures that are no equirectangular maps are mostly square or six to one.
bool hasOddShape(const PictureInfo& info)
{
    const int64_t excess = int64_t(info.width) - 2 * int64_t(info.height);
    return !info.cube && std::abs(excess) > std::max<int64_t>(2, info.width / 50);
}

std::vector<std::string> warningsOf(const EnvironmentSink& sink, const std::string& name)
{
    const PictureInfo& info = sink.info;
    std::vector<std::string> warnings;
    const auto add = [&](const std::string& text)
    { warnings.push_back(fmt::format("environment {}: {}", name, text)); };
    for (const std::string& note : info.notes)
        add(note);
    if (info.cube)
        add("a cube map, which was resampled to an equirectangular one");
    else if (sink.image.width != info.width || sink.image.height != info.height)
        add(fmt::format("its {} x {} texels were averaged to {} x {}", info.width, info.height, sink.image.width,
                        sink.image.height));
    if (hasOddShape(info))
        add(fmt::format("{} x {} texels are taken for an equirectangular map, which would be twice as wide as high",
                        info.width, info.height));
    const Repairs& repairs = sink.repairs;
    const auto count = [&](uint64_t texels, const char* what, const char* instead)
    {
        if (texels > 0)
            add(fmt::format("{} texel{} {} and became {}", texels, texels == 1 ? " is" : "s are", what, instead));
    };
    count(repairs.not_a_number, "NaN", "0");
    count(repairs.infinite, "infinite", "65504");
    count(repairs.negative, "negative", "0");
    return warnings;
}

Result<LoadedEnvironment> decode(Reader reader, std::span<const std::byte> file, const std::string& name, float scale)
{
    EnvironmentSink sink(scale);
    if (const Status status = reader(file, sink); !status)
        return status.error();
    LoadedEnvironment loaded{.image = {}, .warnings = warningsOf(sink, name)};
    loaded.image = sink.info.cube ? toEquirectangular(sink.image) : std::move(sink.image);
    return loaded;
}
} // namespace

Result<LoadedEnvironment> decodeExrEnvironment(std::span<const std::byte> file, const std::string& name, float scale)
{
    return decode(readExr, file, name, scale);
}

Result<LoadedEnvironment> decodeHdrEnvironment(std::span<const std::byte> file, const std::string& name, float scale)
{
    return decode(readHdr, file, name, scale);
}

Result<LoadedEnvironment> loadEnvironment(const std::filesystem::path& path, float scale)
{
    std::string suffix = path.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (suffix != ".exr" && suffix != ".hdr")
        return Error{ExitCode::kUnsupported, "an environment map must be an OpenEXR (.exr) or Radiance (.hdr) file"}
            .about(path.string());
    const Result<package::MappedFile> file = package::MappedFile::open(path);
    if (!file)
        return file.error().about(path.string());
    Result<LoadedEnvironment> loaded = (suffix == ".exr" ? decodeExrEnvironment : decodeHdrEnvironment)(
        file->bytes(), path.filename().string(), scale);
    if (!loaded)
        return loaded.error().about(path.string());
    return loaded;
}
