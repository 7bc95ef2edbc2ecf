// Writes OpenEXR and PNG pictures. Depends on format, OpenEXR and stb only.
#pragma once
#include "format/result.h"
#include "image/image.h"
#include "image/picture_notes.h"

#include <filesystem>
#include <span>

/// Writes `bytes` to a temporary name beside `path`, then renames it: `path` never names a half-written file.
/// Errors: kIo with the system's reason; the temporary file is gone then.
Status writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);

/// Whether writeFile() could begin, for work whose result would be lost if not: its error, and `path` stays as it is.
Status canWriteFile(const std::filesystem::path& path);

/// Channels of an OpenEXR picture that belong together.
struct ExrLayer
{
    std::string name;              // "direct" has channels direct.R, ...; "" is the picture itself and has R, ...
    std::string channels;          // a letter each: "RGB", "XYZ", "Z"
    std::span<const float> values; // [channels * width * height], those of a pixel together, row 0 on top
    bool half = false;             // stored as 16-bit floats, to the largest of which larger values are clamped
};

/// ZIP compression. The same layers give the same bytes, in whatever order: channels are sorted by name.
Status writeExr(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const ExrLayer> layers,
                std::span<const PictureNote> notes = {});

/// One layer: 32-bit float channels R, G, B.
Status writeExr(const std::filesystem::path& path, const ImageF& image, std::span<const PictureNote> notes = {});

/// `texels`: uint8_t[channel_count * width * height], row 0 on top, sRGB-encoded colour as PNG readers expect.
Status writePng(const std::filesystem::path& path, uint32_t width, uint32_t height, uint32_t channel_count,
                std::span<const uint8_t> texels, std::span<const PictureNote> notes = {});

/// The bytes that writePng() would write.
std::vector<uint8_t> encodePng(uint32_t width, uint32_t height, uint32_t channel_count, std::span<const uint8_t> texels,
                               std::span<const PictureNote> notes = {});

/// IEC 61966-2-1 transfer curve of `linear` clamped to 0..1, as a byte; not-a-number becomes 0.
uint8_t srgbByte(float linear);
