#include "compiler/ktx2.h"

#include "compiler/ktx2_texels.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace
{
constexpr std::array<uint8_t, 12> kIdentifier{0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
constexpr uint64_t kMaxExpansion = 4096; // of compressed levels: bounds what a small file can make us allocate

struct Header // as far as it is looked at
{
    uint32_t vk_format, type_size;
    uint32_t width, height, depth;
    uint32_t layers, faces, levels;
    uint32_t supercompression;
    uint32_t dfd_offset; // data format descriptor
};

struct Level
{
    uint64_t offset, bytes, raw_bytes;
};

enum Supercompression : uint32_t
{
    kNone = 0,
    kBasisLz = 1,
    kZstd = 2,
    kZlib = 3
};

template <typename... Args>
Error invalid(fmt::format_string<Args...> format, Args&&... args)
{
    return {ExitCode::kInvalid, fmt::format(format, std::forward<Args>(args)...)};
}
template <typename... Args>
Error unsupported(fmt::format_string<Args...> format, Args&&... args)
{
    return {ExitCode::kUnsupported, fmt::format(format, std::forward<Args>(args)...)};
}

class Reader
{
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}
    /// 0 past the end.
    template <typename T>
    T at(uint64_t offset) const
    {
        T value{};
        if (offset <= bytes_.size() && sizeof(T) <= bytes_.size() - offset)
            std::memcpy(&value, bytes_.data() + offset, sizeof(T));
        return value;
    }
    bool holds(uint64_t offset, uint64_t count) const
    {
        return offset <= bytes_.size() && count <= bytes_.size() - offset;
    }
    std::span<const std::byte> range(uint64_t offset, uint64_t count) const { return bytes_.subspan(offset, count); }

private:
    std::span<const std::byte> bytes_;
};

constexpr uint64_t kHeaderBytes = 80;

Result<Header> readHeader(const Reader& file)
{
    if (!file.holds(0, kHeaderBytes))
        return invalid("it ends within the header of a KTX2 file");
    Header h{};
    uint32_t* const words[] = {&h.vk_format, &h.type_size, &h.width,  &h.height,           &h.depth,
                               &h.layers,    &h.faces,     &h.levels, &h.supercompression, &h.dfd_offset};
    for (size_t i = 0; i < std::size(words); ++i)
        *words[i] = file.at<uint32_t>(kIdentifier.size() + 4 * i);
    if (h.width == 0)
        return invalid("it is a KTX2 file without a width");
    if (h.height == 0)
        return unsupported("it is a one-dimensional KTX2 texture, which is not supported");
    if (h.depth > 0 || h.layers > 0)
        return unsupported("it is a KTX2 {}, which is not supported; export a plain texture",
                           h.depth > 0 ? "volume" : "array");
    if (h.faces != 1)
        return h.faces == 6 ? unsupported("it is a KTX2 cube map, which is not supported; export a plain texture")
                            : invalid("it is a KTX2 file of {} faces", h.faces);
    if (h.levels > 32)
        return invalid("it is a KTX2 file of {} levels", h.levels);
    return h;
}

/// Basis Universal and other formats, by the data format descriptor's colour model.
Error unsupportedFormat(const Header& header, const Reader& file)
{
    constexpr uint32_t kEtc1s = 163, kUastc = 166;
    const uint32_t model = file.at<uint32_t>(uint64_t(header.dfd_offset) + 12) & 0xff;
    if (header.supercompression == kBasisLz || (header.vk_format == 0 && model == kEtc1s))
        return unsupported(
            "it is KTX2 of Basis Universal ETC1S, which is not supported; export it as PNG, JPEG, WebP or "
            "uncompressed KTX2");
    if (header.vk_format == 0 && model == kUastc)
        return unsupported(
            "it is KTX2 of Basis Universal UASTC, which is not supported; export it as PNG, JPEG, WebP or "
            "uncompressed KTX2");
    return unsupported(
        "it is KTX2 of VkFormat {}, which is not supported; export it as PNG, JPEG, WebP or uncompressed KTX2",
        header.vk_format);
}

Result<std::vector<std::byte>> inflate(const Header& header, std::span<const std::byte> stored, uint64_t raw_bytes)
{
    if (raw_bytes / kMaxExpansion > stored.size())
        return invalid("its KTX2 level cannot hold {} bytes in {}", raw_bytes, stored.size());
    std::vector<std::byte> raw(raw_bytes);
    if (header.supercompression == kZstd)
    {
        const size_t size = ZSTD_decompress(raw.data(), raw.size(), stored.data(), stored.size());
        if (ZSTD_isError(size) != 0 || size != raw.size())
            return invalid("its KTX2 level is no zstd data of {} bytes", raw_bytes);
        return raw;
    }
    uLongf size = uLongf(raw.size());
    if (uncompress(reinterpret_cast<Bytef*>(raw.data()), &size, reinterpret_cast<const Bytef*>(stored.data()),
                   uLong(stored.size())) != Z_OK ||
        size != raw.size())
        return invalid("its KTX2 level is no zlib data of {} bytes", raw_bytes);
    return raw;
}
} // namespace

bool isKtx2(std::span<const std::byte> bytes)
{
    return bytes.size() >= kIdentifier.size() && std::memcmp(bytes.data(), kIdentifier.data(), kIdentifier.size()) == 0;
}

Result<Ktx2Image> decodeKtx2(std::span<const std::byte> bytes,
                             const std::function<Status(uint32_t width, uint32_t height)>& accept)
{
    const Reader file(bytes);
    const Result<Header> header = readHeader(file);
    if (!header)
        return header.error();
    const std::optional<Ktx2Format> format = ktx2Format(header->vk_format);
    if (!format || header->supercompression == kBasisLz)
        return unsupportedFormat(*header, file);
    if (header->supercompression > kZlib)
        return unsupported("it is KTX2 of supercompression scheme {}, which is not supported",
                           header->supercompression);
    const Level level{file.at<uint64_t>(kHeaderBytes), file.at<uint64_t>(kHeaderBytes + 8),
                      file.at<uint64_t>(kHeaderBytes + 16)}; // the largest comes first
    if (!file.holds(kHeaderBytes, uint64_t(24) * std::max(header->levels, 1u)) ||
        !file.holds(level.offset, level.bytes))
        return invalid("its KTX2 levels lie past the end of the file");
    if (Status status = accept(header->width, header->height); !status)
        return status.error();
    const uint64_t raw_bytes = ktx2LevelBytes(*format, header->width, header->height);
    const uint64_t stated = header->supercompression == kNone ? level.bytes : level.raw_bytes;
    if (stated != raw_bytes)
        return invalid("its KTX2 level has {} bytes, but {} x {} texels take {}", stated, header->width, header->height,
                       raw_bytes);
    Ktx2Image image;
    image.width = header->width;
    image.height = header->height;
    std::span<const std::byte> raw = file.range(level.offset, level.bytes);
    std::vector<std::byte> inflated;
    if (header->supercompression != kNone)
    {
        Result<std::vector<std::byte>> result = inflate(*header, raw, raw_bytes);
        if (!result)
            return result.error();
        inflated = std::move(*result);
        raw = inflated;
    }
    decodeKtx2Level(*format, raw, image);
    return image;
}
