#include "image/exr_headers.h"

#include "image/exr_stream.h"
#include "image/picture.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <string_view>

namespace
{
Error invalid(std::string message)
{
    return {ExitCode::kInvalid, std::move(message)};
}

constexpr size_t kMagicBytes = 8; // and version

constexpr size_t kNotTextLength = std::string_view::npos;

/// Takes a text that a zero ends off `bytes`. @return its length, or npos where none ends
size_t takeText(std::string_view& bytes)
{
    const size_t length = bytes.find('\0');
    bytes.remove_prefix(length == kNotTextLength ? bytes.size() : length + 1);
    return length;
}

/// @return the number that `bytes` begin with, nothing where they are fewer
std::optional<uint32_t> takeNumber(std::string_view& bytes)
{
    uint32_t number = 0;
    if (bytes.size() < sizeof(number))
        return std::nullopt;
    std::memcpy(&number, bytes.data(), sizeof(number));
    bytes.remove_prefix(sizeof(number));
    return number;
}

/// Names, each with a 16-byte description, ended by an empty name.
bool isChannelList(std::string_view value)
{
    constexpr size_t kDescriptionBytes = 16;
    for (;;)
    {
        const size_t name = takeText(value);
        if (name == 0 || name == kNotTextLength)
            return name == 0 && value.empty();
        if (value.size() < kDescriptionBytes)
            return false;
        value.remove_prefix(kDescriptionBytes);
    }
}

/// Texts, each after its length.
bool isTextList(std::string_view value)
{
    while (!value.empty())
    {
        const std::optional<uint32_t> length = takeNumber(value);
        if (!length || *length > value.size())
            return false;
        value.remove_prefix(*length);
    }
    return true;
}

/// Width, height, and four bytes a pixel.
bool isPreview(std::string_view value)
{
    const std::optional<uint32_t> width = takeNumber(value), height = takeNumber(value);
    return height && uint64_t(*width) * *height <= value.size() / 4 && uint64_t(*width) * *height * 4 == value.size();
}

/// Whether `value` has the length that values of `type` have. The library reads a value by its type, whatever size the file
/// says that it has: where the two differ it takes what follows for something else.
bool hasLengthOfType(std::string_view type, std::string_view value)
{
    struct TypeBytes
    {
        std::string_view type;
        size_t bytes;
    };
    static constexpr auto kFixed = std::to_array<TypeBytes>({{"box2f", 16},
                                                             {"box2i", 16},
                                                             {"chromaticities", 32},
                                                             {"compression", 1},
                                                             {"deepImageState", 1},
                                                             {"double", 8},
                                                             {"envmap", 1},
                                                             {"float", 4},
                                                             {"int", 4},
                                                             {"keycode", 28},
                                                             {"lineOrder", 1},
                                                             {"m33d", 72},
                                                             {"m33f", 36},
                                                             {"m44d", 128},
                                                             {"m44f", 64},
                                                             {"rational", 8},
                                                             {"tiledesc", 9},
                                                             {"timecode", 8},
                                                             {"v2d", 16},
                                                             {"v2f", 8},
                                                             {"v2i", 8},
                                                             {"v3d", 24},
                                                             {"v3f", 12},
                                                             {"v3i", 12}});
    if (const auto fixed = std::ranges::find(kFixed, type, &TypeBytes::type); fixed != kFixed.end())
        return value.size() == fixed->bytes;
    if (type == "chlist")
        return isChannelList(value);
    if (type == "stringvector")
        return isTextList(value);
    if (type == "preview")
        return isPreview(value);
    return true; // text, floats and unknown types are as long as the file says
}

/// An attribute is its name and its type, each ended by a zero, its size and as many bytes; an empty name ends a
/// header, an empty header the list of several. The library makes room for a size before it finds that the file ends.
Status checkAttributes(std::span<const std::byte> file, bool several_parts)
{
    std::string_view left(reinterpret_cast<const char*>(file.data()), file.size());
    left.remove_prefix(kMagicBytes);
    const Error cut = invalid("the EXR image is cut off or damaged within its header");
    for (bool header_is_empty = true;;)
    {
        const size_t name = takeText(left);
        if (name == kNotTextLength)
            return cut;
        if (name == 0)
        {
            if (!several_parts || header_is_empty)
                return Success{};
            header_is_empty = true;
            continue;
        }
        header_is_empty = false;
        const std::string_view type = left.substr(0, left.find('\0'));
        if (takeText(left) == kNotTextLength)
            return cut;
        const std::optional<uint32_t> bytes = takeNumber(left);
        if (!bytes || *bytes > left.size())
            return cut;
        if (!hasLengthOfType(type, left.substr(0, *bytes)))
            return invalid(fmt::format("the EXR image is damaged: an attribute of type {} has {} bytes", type, *bytes));
        left.remove_prefix(*bytes);
    }
}

/// Pixels that may be in memory at once: no file of that size holds more. The densest compression, DWA, takes 4 bytes for an even
/// square of 8 x 8 values and deflates those, to a thousandth at best. Small files may still have a tile of the usual sizes.
int64_t mostHeldPixels(const Imf::Header& header, size_t file_bytes)
{
    constexpr int64_t kDensest = 1 << 16, kUsualBytes = 1 << 28;
    int64_t channels = 0;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel)
        ++channels;
    const int64_t bytes = std::max(int64_t(std::min<uint64_t>(file_bytes, kMaxPicturePixels)) * kDensest, kUsualBytes);
    return std::min(bytes / int64_t(sizeof(float)) / std::max<int64_t>(channels, 1), kMaxPicturePixels / 4);
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
        if (columns * tiles.xSize > mostHeldPixels(header, file_bytes) / int64_t(tiles.ySize))
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
