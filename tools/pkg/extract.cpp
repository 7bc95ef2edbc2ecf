#include "format/mapped_file.h"
#include "format/package_container.h"
#include "format/package_read.h"
#include "format/texture_encoding.h"
#include "image/write_image.h"
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

/// Parses "NAME", "NAME/1" or "NAME/1/2".
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

/// RGBA8 of one layer of level 0.
std::vector<uint8_t> decoded(const lumicut::fb::TexturePage& page, std::span<const std::byte> stored)
{
    std::vector<uint8_t> rgba(size_t(4) * page.width() * page.height());
    const uint32_t across = blocks::acrossSide(page.width()), bytes = package::unitBytes(page.encoding());
    for (size_t i = 0; i < stored.size() / bytes; ++i)
    {
        const std::byte* block = stored.data() + i * bytes;
        const blocks::Texels texels = page.encoding() == package::TextureEncoding::Bc4Unorm
                                          ? blocks::decodeBc4(std::span<const std::byte, 8>(block, 8))
                                      : page.encoding() == package::TextureEncoding::Bc5Unorm
                                          ? blocks::decodeBc5(std::span<const std::byte, 16>(block, 16))
                                          : blocks::decodeBc7(std::span<const std::byte, 16>(block, 16));
        for (uint32_t k = 0; k < 16; ++k)
        {
            const size_t x = i % across * blocks::kSide + k % blocks::kSide,
                         y = i / across * blocks::kSide + k / blocks::kSide;
            if (x < page.width() && y < page.height())
                std::memcpy(&rgba[4 * (y * page.width() + x)], texels[k].data(), 4);
        }
    }
    return rgba;
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
    const uint64_t bytes = package::levelBytes(p.encoding(), p.width(), p.height()); // of a layer of level 0
    const std::span<const std::byte> stored = package.texturePage(page).subspan(layer * bytes, bytes);
    if (!package::isBlocks(p.encoding()))
        return writePng(output, p.width(), p.height(), 4, asBytes(stored));
    return writePng(output, p.width(), p.height(), 4, decoded(p, stored));
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
