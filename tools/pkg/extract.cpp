#include "format/mapped_file.h"
#include "format/package_container.h"
#include "format/package_read.h"
#include "tools/image/write_image.h"
#include "tools/pkg/commands.h"
#include "tools/pkg/geometry.h"

#include <array>
#include <charconv>
#include <cstring>

namespace
{
std::span<const uint8_t> asBytes(std::span<const std::byte> bytes)
{
    return {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
}

/// "NAME", "NAME/1" or "NAME/1/2".
struct Wanted
{
    std::string name;
    std::array<uint32_t, 2> number{};
    size_t number_count = 0;
};

std::optional<Wanted> parseWanted(const std::string& text)
{
    Wanted wanted{text.substr(0, text.find('/')), {}, 0};
    const char* at = text.data() + wanted.name.size();
    const char* const end = text.data() + text.size();
    while (at != end)
    {
        if (wanted.number_count == wanted.number.size())
            return std::nullopt;
        const auto [next, failure] = std::from_chars(at + 1, end, wanted.number[wanted.number_count++]);
        if (failure != std::errc() || (next != end && *next != '/'))
            return std::nullopt;
        at = next;
    }
    return wanted;
}

Status extractTexture(const package::Package& package, const Wanted& wanted, const std::filesystem::path& output)
{
    const auto& pages = *package.meta().texture_pages();
    const auto [page, layer] = wanted.number;
    if (wanted.number_count != 2 || page >= pages.size() || layer >= pages[page]->layers())
        return Error{ExitCode::kUsage,
                     fmt::format("there is no such texture; say texture/PAGE/LAYER as `lumicut-pkg info` "
                                 "counts them from 0 ({} pages)",
                                 pages.size())};
    const lumicut::fb::TexturePage& p = *pages[page];
    const bool rgba8 = p.encoding() == lumicut::fb::TextureEncoding::Rgba8Srgb ||
                       p.encoding() == lumicut::fb::TextureEncoding::Rgba8Unorm;
    if (!rgba8)
        return Error{ExitCode::kUnsupported,
                     fmt::format("its texels are block-compressed ({}); extract TEXP/{} instead",
                                 lumicut::fb::EnumNameTextureEncoding(p.encoding()), page)};
    const size_t bytes = size_t(4) * p.width() * p.height();
    return writePng(output, p.width(), p.height(), 4, asBytes(package.texturePage(page).subspan(layer * bytes, bytes)));
}

Status extractEnvironment(const package::Package& package, const std::filesystem::path& output)
{
    const lumicut::fb::Environment* const e = package.meta().environment();
    if (e == nullptr)
        return Error{ExitCode::kUsage, "the package has no environment map"};
    ImageF image{e->width(), e->height(), {}};
    for (const gpu::vec4& texel : package.environmentMap())
        image.rgb.insert(image.rgb.end(), {texel.x, texel.y, texel.z});
    return writeExr(output, image);
}

Status extractChunk(const std::filesystem::path& path, const Wanted& wanted, const std::filesystem::path& output)
{
    const Result<package::MappedFile> file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    const Result<package::Container> container = package::readContainer(file->bytes());
    if (!container)
        return container.error();
    for (size_t i = 0; i < container->table.size(); ++i)
        if (package::chunkName(container->table[i].id) == wanted.name &&
            container->table[i].index == wanted.number[0] && wanted.number_count < 2)
            return writeFile(output, asBytes(container->chunks[i]));
    return Error{ExitCode::kUsage,
                 "the package has nothing of this name; say geometry, environment, texture/PAGE/LAYER, or "
                 "a chunk that `lumicut-pkg info` lists, as in NODE or TEXP/1"};
}

Status checkSuffix(const Wanted& wanted, const std::filesystem::path& output)
{
    const std::string suffix = wanted.name == "geometry"      ? ".glb"
                               : wanted.name == "environment" ? ".exr"
                               : wanted.name == "texture"     ? ".png"
                                                              : "";
    if (!suffix.empty() && output.extension() != suffix)
        return Error{ExitCode::kUsage, fmt::format("{} is written as {}; name the output so", wanted.name, suffix)};
    return Success{};
}

Status extractWanted(const std::filesystem::path& path, const std::string& what, const std::filesystem::path& output)
{
    const std::optional<Wanted> wanted = parseWanted(what);
    if (!wanted)
        return Error{ExitCode::kUsage, fmt::format("\"{}\" is not a name with numbers behind slashes", what)};
    if (Status status = checkSuffix(*wanted, output); !status)
        return status;
    if (wanted->name != "geometry" && wanted->name != "environment" && wanted->name != "texture")
        return extractChunk(path, *wanted, output);
    const auto package = package::Package::open(path);
    if (!package)
        return package.error();
    if (wanted->name == "geometry")
        return writeFile(output, geometryGlb(*package));
    if (wanted->name == "environment")
        return extractEnvironment(*package, output);
    return extractTexture(*package, *wanted, output);
}
} // namespace

ExitCode extract(const std::filesystem::path& package, const std::string& what, const std::filesystem::path& output)
{
    const Status status = extractWanted(package, what, output);
    if (!status)
        return report(status.error().code == ExitCode::kIo && std::filesystem::exists(package) ? output : package,
                      status.error());
    return ExitCode::kOk;
}
