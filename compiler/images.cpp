#include "compiler/images.h"

#include "compiler/ktx2.h"
#include "compiler/parallel.h"

#include <fmt/format.h>
#include <stb_image.h>
#include <webp/decode.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

namespace
{
constexpr uint32_t kMaxSide = 16384;               // texels
constexpr uint64_t kMaxTexels = uint64_t(1) << 30; // of all images together: 4 GiB, and as much again for pages
using Bytes = std::vector<unsigned char>;

Error undecodable(const GltfImage& image, std::string_view reason)
{
    return {ExitCode::kInvalid, fmt::format("texture \"{}\" cannot be decoded: {}", image.name.substr(0, 200), reason)};
}

/// The first bytes of other picture formats, for a helpful message.
std::string_view formatName(std::string_view start)
{
    struct Magic
    {
        size_t at;
        std::string_view bytes;
        std::string_view name;
    };
    using namespace std::string_view_literals;
    constexpr Magic kMagics[] = {{0, "BM"sv, "a BMP"},
                                 {0, "GIF8"sv, "a GIF"},
                                 {0, "DDS "sv, "a DDS"},
                                 {4, "ftypavif"sv, "an AVIF"},
                                 {4, "ftypheic"sv, "a HEIC"},
                                 {0, "II*\0"sv, "a TIFF"},
                                 {0, "MM\0*"sv, "a TIFF"},
                                 {0, "8BPS"sv, "a PSD"},
                                 {0, "\x76\x2F\x31\x01"sv, "an OpenEXR"},
                                 {0, "#?RADIANCE"sv, "a Radiance"},
                                 {0, "\xFF\x0A"sv, "a JPEG XL"},
                                 {4, "JXL "sv, "a JPEG XL"},
                                 {4, "jP  "sv, "a JPEG 2000"}};
    for (const Magic& magic : kMagics)
        if (start.size() >= magic.at && start.substr(magic.at).starts_with(magic.bytes))
            return magic.name;
    return {};
}

/// stb's reason, or a more specific one.
std::string decoderReason(bool png)
{
    const char* reason = stbi_failure_reason();
    if (reason == nullptr || *reason == '\0')
        return "it is damaged or cut short";
    if (std::string_view(reason) != "unknown image type")
        return fmt::format("it is damaged or of a rare kind ({})", reason);
    return png ? "its PNG header is damaged"
               : "it is cut short, or a JPEG of a kind that is not read (12-bit, arithmetic, lossless)";
}

Result<ByteView> imageBytes(const GltfFile& file, const GltfImage& image, Bytes& storage)
{
    if (image.uri.empty() && image.buffer_view == -1)
        return Error{ExitCode::kInvalid, "it names neither a file nor a buffer view"};
    if (image.uri.empty())
        return viewBytes(file.model, image.buffer_view);
    Result<Bytes> bytes = readUri(image.uri, *file.files);
    if (!bytes)
        return bytes.error();
    storage = std::move(*bytes);
    return ByteView{storage.data(), storage.size(), 0};
}

/// Resizes `out` if the sides and the total of all images are within the limits; before any texel is decoded.
Status reserve(int width, int height, const GltfImage& image, std::atomic<uint64_t>& texels, TextureImage& out)
{
    if (width <= 0 || height <= 0 || uint32_t(std::max(width, height)) > kMaxSide)
        return undecodable(image, fmt::format("its sides must be 1 to {} texels", kMaxSide));
    if (texels.fetch_add(uint64_t(width) * uint64_t(height)) + uint64_t(width) * uint64_t(height) > kMaxTexels)
        return undecodable(image, "the textures are too large together"); // ends the compilation, see decodeImages()
    out.width = uint32_t(width);
    out.height = uint32_t(height);
    return Success{};
}

Status decodeWebp(const ByteView& bytes, const GltfImage& image, std::atomic<uint64_t>& texels, TextureImage& out)
{
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(bytes.data, bytes.bytes, &features) != VP8_STATUS_OK || features.has_animation != 0)
        return undecodable(image, "it is no valid WebP still picture");
    if (Status status = reserve(features.width, features.height, image, texels, out); !status)
        return status;
    out.texels.resize(size_t(4) * out.width * out.height);
    if (WebPDecodeRGBAInto(bytes.data, bytes.bytes, out.texels.data(), out.texels.size(), int(out.width * 4)) ==
        nullptr)
        return undecodable(image, "its WebP data is damaged");
    return Success{};
}

Status decodePng16(const ByteView& bytes, const GltfImage& image, TextureImage& out)
{
    int width = 0;
    int height = 0;
    int channels = 0;
    const std::unique_ptr<stbi_us, decltype(&stbi_image_free)> decoded(
        stbi_load_16_from_memory(bytes.data, int(bytes.bytes), &width, &height, &channels, 4), &stbi_image_free);
    if (decoded == nullptr)
        return undecodable(image, decoderReason(true));
    out.deep.assign(decoded.get(), decoded.get() + size_t(4) * out.width * out.height);
    out.texels.resize(out.deep.size());
    std::transform(out.deep.begin(), out.deep.end(), out.texels.begin(),
                   [](uint16_t word) { return uint8_t((word + 128u) / 257); });
    return Success{};
}

Status decodePngOrJpeg(const ByteView& bytes, const GltfImage& image, std::atomic<uint64_t>& texels, TextureImage& out)
{
    if (bytes.bytes > size_t(INT32_MAX))
        return undecodable(image, "it is larger than 2 GiB");
    int width = 0;
    int height = 0;
    int channels = 0;
    const bool png = bytes.bytes > 0 && bytes.data[0] == 0x89;
    if (stbi_info_from_memory(bytes.data, int(bytes.bytes), &width, &height, &channels) == 0)
        return undecodable(image, decoderReason(png));
    if (Status status = reserve(width, height, image, texels, out); !status)
        return status;
    if (stbi_is_16_bit_from_memory(bytes.data, int(bytes.bytes)) != 0)
        return decodePng16(bytes, image, out);
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> decoded(
        stbi_load_from_memory(bytes.data, int(bytes.bytes), &width, &height, &channels, 4), &stbi_image_free);
    if (decoded == nullptr)
        return undecodable(image, decoderReason(png));
    out.texels.assign(decoded.get(), decoded.get() + size_t(4) * out.width * out.height);
    return Success{};
}

Status decodeKtx2File(const ByteView& bytes, const GltfImage& image, std::atomic<uint64_t>& texels, TextureImage& out)
{
    bool refused = false;
    Result<Ktx2Image> decoded = decodeKtx2(std::as_bytes(std::span(bytes.data, bytes.bytes)),
                                           [&](uint32_t width, uint32_t height)
                                           {
                                               Status status =
                                                   reserve(int(std::min(width, kMaxSide + 1)),
                                                           int(std::min(height, kMaxSide + 1)), image, texels, out);
                                               refused = !status;
                                               return status;
                                           });
    if (!decoded)
        return refused ? decoded.error()
                       : Error{decoded.error().code, undecodable(image, decoded.error().message).message};
    out.texels = std::move(decoded->texels);
    out.deep = std::move(decoded->deep);
    out.linear_light = decoded->linear_light;
    return Success{};
}

/// Encodes linear colours as colour textures are encoded.
void encodeLight(TextureImage& image)
{
    for (size_t i = 0; i < image.deep.size(); ++i)
    {
        if (i % 4 == 3)
            continue;
        const double l = image.deep[i] / 65535.0;
        const double s = l <= 0.0031308 ? l * 12.92 : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
        image.deep[i] = uint16_t(std::lround(s * 65535));
        image.texels[i] = uint8_t(std::lround(s * 255));
    }
    image.linear_light = false;
}

Result<TextureImage> decode(const GltfFile& file, const GltfImage& image, std::atomic<uint64_t>& texels)
{
    Bytes storage;
    const Result<ByteView> bytes = imageBytes(file, image, storage);
    if (!bytes)
        return Error{bytes.error().code, fmt::format("texture \"{}\": {}", image.name.substr(0, 200),
                                                     withoutFolder(bytes.error().message, file.files->folder()))};
    const std::string_view start(reinterpret_cast<const char*>(bytes->data), std::min<size_t>(bytes->bytes, 16));
    TextureImage out;
    out.name = image.name;
    if (start.empty())
        return undecodable(image, "it is empty");
    if (isKtx2(std::as_bytes(std::span(bytes->data, bytes->bytes))))
    {
        if (const Status status = decodeKtx2File(*bytes, image, texels, out); !status)
            return status.error();
        return out;
    }
    if (const std::string_view name = formatName(start); !name.empty())
        return Error{ExitCode::kUnsupported,
                     fmt::format("texture \"{}\" is {} file, which is not read; export it as PNG, "
                                 "JPEG, WebP or KTX2",
                                 image.name.substr(0, 200), name)};
    const bool webp = start.size() >= 12 && start.starts_with("RIFF") && start.substr(8, 4) == "WEBP";
    const bool png_or_jpeg = start.starts_with("\x89PNG") || start.starts_with("\xFF\xD8");
    if (!webp && !png_or_jpeg)
        return undecodable(image, "it is neither PNG, JPEG, WebP nor KTX2");
    const Status status = webp ? decodeWebp(*bytes, image, texels, out) : decodePngOrJpeg(*bytes, image, texels, out);
    if (!status)
        return status.error();
    return out;
}
} // namespace

Result<std::vector<DecodedImage>> decodeImages(const GltfFile& file, std::span<const ImageRequest> requests)
{
    std::vector<std::optional<Result<TextureImage>>> decoded(requests.size());
    std::atomic<uint64_t> texels{0};
    const auto first_use = [&](size_t i) // an image used as colour and as data is decoded once
    {
        size_t first = 0;
        while (requests[first].source != requests[i].source)
            ++first;
        return first;
    };
    parallelFor(requests.size(),
                [&](size_t i)
                {
                    if (first_use(i) == i)
                        decoded[i] = decode(file, file.images[size_t(requests[i].source)], texels);
                });
    if (texels > kMaxTexels)
        return Error{ExitCode::kUnsupported,
                     fmt::format("its textures have more than {} texels together; make them smaller", kMaxTexels)};
    std::vector<DecodedImage> images;
    for (size_t i = 0; i < requests.size(); ++i)
    {
        const size_t first = first_use(i);
        DecodedImage image{requests[i].source, {}, std::nullopt};
        if (first < i)
            image = images[first];
        else if (*decoded[i])
            image.image = std::move(**decoded[i]);
        else
            image.error = decoded[i]->error();
        image.image.srgb = requests[i].srgb;
        images.push_back(std::move(image));
    }
    for (DecodedImage& decoded_image : images) // only now: other requests may have been copied from it
        if (TextureImage& image = decoded_image.image; image.srgb && image.linear_light)
            encodeLight(image);
    return images;
}
