#include "image/picture_file.h"

#include "format/mapped_file.h"
#include "image/exr_headers.h"
#include "image/exr_stream.h"
#include "image/png_chunks.h"

#include <OpenEXR/ImfInputFile.h>

#include <algorithm>
#include <array>

namespace
{
using Bytes = std::span<const std::byte>;

/// Whether the file begins with `magic`, or would if it were longer.
bool beginsWith(Bytes file, std::span<const uint8_t> magic)
{
    const size_t count = std::min(file.size(), magic.size());
    return std::equal(file.begin(), file.begin() + ptrdiff_t(count), magic.begin(),
                      [](std::byte a, uint8_t b) { return uint8_t(a) == b; });
}

PictureState pngState(Bytes file, uint32_t width, uint32_t height)
{
    if (!beginsWith(file, kPngMagic))
        return PictureState::kOther;
    PictureState state = PictureState::kIncomplete;
    forEachPngChunk(file,
                    [&](uint32_t type, Bytes data)
                    {
                        if (type == kPngHeader && data.size() >= 8 &&
                            (bigEndian(data, 0) != width || bigEndian(data, 4) != height))
                            state = PictureState::kOther;
                        else if (type == kPngEnd)
                            state = PictureState::kWhole;
                        return state == PictureState::kIncomplete;
                    });
    return state;
}

/// The library has the table of blocks checked; the last of them, at the end of the file, must be all there.
PictureState exrState(Bytes file, uint32_t width, uint32_t height)
{
    constexpr std::array<uint8_t, 4> kMagic{0x76, 0x2f, 0x31, 0x01};
    if (!beginsWith(file, kMagic))
        return PictureState::kOther;
    const auto headers = readExrHeaders(file);
    if (!headers)
        return PictureState::kIncomplete;
    const Imf::Header& header = headers->front();
    const ExrWindow window(header.dataWindow());
    if (headers->size() != 1 || header.hasTileDescription() || window.width() != width || window.height() != height)
        return PictureState::kOther;
    ExrStream stream(file);
    Imf::InputFile input(stream);
    const char* block = nullptr;
    int block_bytes = 0;
    if (!input.isComplete())
        return PictureState::kIncomplete;
    input.rawPixelData(header.dataWindow().max.y, block, block_bytes);
    return PictureState::kWhole;
}
} // namespace

PictureState pictureState(const std::filesystem::path& path, uint32_t width, uint32_t height)
{
    std::error_code problem;
    const auto status = std::filesystem::symlink_status(path, problem);
    if (status.type() == std::filesystem::file_type::not_found)
        return PictureState::kNone;
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error().code == ExitCode::kInvalid ? PictureState::kIncomplete : PictureState::kOther; // or empty
    try
    {
        return path.extension() == ".png" ? pngState(file->bytes(), width, height)
                                          : exrState(file->bytes(), width, height);
    }
    catch (const std::exception&) // of the library, where a block ends too early
    {
        return PictureState::kIncomplete;
    }
}
