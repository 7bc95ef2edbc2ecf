#include "image/exr_headers.h"

#include "image/exr_stream.h"
#include "image/picture.h"

#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace
{
Error invalid(std::string message)
{
    return {ExitCode::kInvalid, std::move(message)};
}

constexpr size_t kMagicBytes = 8; // and version

/// An attribute is its name and its type, each ended by a zero, its size and as many bytes; an empty name ends a
/// header, an empty header the list of several. The library makes room for a size before it finds that the file ends.
Status checkAttributes(std::span<const std::byte> file, bool several_parts)
{
    std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    text.remove_prefix(kMagicBytes);
    const Error cut = invalid("the EXR image is cut off or damaged within its header");
    for (bool header_is_empty = true;;)
    {
        const size_t name = text.find('\0');
        if (name == std::string_view::npos)
            return cut;
        text.remove_prefix(name + 1);
        if (name == 0)
        {
            if (!several_parts || header_is_empty)
                return Success{};
            header_is_empty = true;
            continue;
        }
        header_is_empty = false;
        const size_t type = text.find('\0');
        uint32_t bytes = 0;
        if (type == std::string_view::npos || text.size() - type - 1 < sizeof(bytes))
            return cut;
        text.remove_prefix(type + 1);
        std::memcpy(&bytes, text.data(), sizeof(bytes));
        text.remove_prefix(sizeof(bytes));
        if (bytes > text.size())
            return cut;
        text.remove_prefix(bytes);
    }
}

/// A file that holds less than the headers of its blocks is cut off, whatever the compression.
Status checkBlocks(const Imf::Header& header, const ExrWindow& data, size_t file_bytes)
{
    constexpr int64_t kBlockBytes = 16; // entry in the offset table, coordinate, size
    const auto parts = [](int64_t whole, int64_t part) { return (whole + part - 1) / part; };
    int64_t columns = 1;
    if (header.hasTileDescription())
    {
        const Imf::TileDescription& tiles = header.tileDescription();
        if (tiles.xSize < 1 || tiles.ySize < 1)
            return invalid("the EXR image has tiles of no pixels");
        columns = parts(data.width(), tiles.xSize);
        // The library holds a row of whole tiles, also where they are larger than the picture.
        if (columns * tiles.xSize > kMaxPicturePixels / 4 / int64_t(tiles.ySize))
            return Error{ExitCode::kUnsupported,
                         fmt::format("the EXR image has tiles of {} x {} pixels, which are too large; save it "
                                     "with smaller ones",
                                     tiles.xSize, tiles.ySize)};
    }
    const int64_t blocks = columns * parts(data.height(), exrStripRows(header));
    if (blocks * kBlockBytes > int64_t(file_bytes))
        return invalid(fmt::format("the EXR image is cut off: {} bytes cannot hold {} blocks", file_bytes, blocks));
    return Success{};
}
} // namespace

int64_t exrStripRows(const Imf::Header& header)
{
    if (header.hasTileDescription())
        return header.tileDescription().ySize;
    return header.compression() == Imf::DWAB_COMPRESSION ? 256
                                                         : 32; // other compressions' blocks have 1, 16 or 32 lines
}

Status checkExrWindow(const ExrWindow& window, const char* name)
{
    if (window.width() < 1 || window.height() < 1)
        return invalid(fmt::format("the EXR image's {} window is empty", name));
    if (window.width() > kMaxPictureSide || window.height() > kMaxPictureSide ||
        window.width() * window.height() > kMaxPicturePixels)
        return Error{
            ExitCode::kUnsupported,
            fmt::format("the EXR image's {} window has {} x {} pixels, allowed are sides of {} and {} pixels in all",
                        name, window.width(), window.height(), kMaxPictureSide, kMaxPicturePixels)};
    constexpr int64_t kFarthest = 1 << 24; // keeps addresses relative to the origin within range
    if (std::max({-window.min_x, window.max_x, -window.min_y, window.max_y}) > kFarthest)
        return invalid(fmt::format("the EXR image's {} window lies more than {} pixels from 0", name, kFarthest));
    return Success{};
}

Result<std::vector<Imf::Header>> readExrHeaders(std::span<const std::byte> file)
{
    constexpr std::array kMagic{std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
    if (file.size() < kMagicBytes || !std::ranges::equal(file.first(kMagic.size()), kMagic))
        return invalid("the file is not an OpenEXR image");
    int version = 0;
    std::memcpy(&version, file.data() + kMagic.size(), sizeof(version));
    const bool several_parts = Imf::isMultiPart(version);
    if (const Status status = checkAttributes(file, several_parts); !status)
        return status.error();

    ExrStream stream(file);
    stream.seekg(kMagicBytes);
    std::vector<Imf::Header> headers;
    do
    {
        Imf::Header header;
        header.readFrom(stream, version);
        if (several_parts && header.readsNothing())
            break;
        const ExrWindow data(header.dataWindow());
        if (const Status status = checkExrWindow(data, "data"); !status)
            return status.error();
        if (const Status status = checkBlocks(header, data, file.size()); !status)
            return status.error();
        headers.push_back(std::move(header));
    } while (several_parts);
    return headers;
}
