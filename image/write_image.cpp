#include "image/write_image.h"

#include "format/check.h"
#include "format/temporary_file.h"
#include "image/png_chunks.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <half.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace
{

Error cannotWrite(const char* what)
{
    return {ExitCode::kIo, fmt::format("The file cannot be {}: {}.", what, std::strerror(errno))};
}

std::vector<Imath::half> toHalf(std::span<const float> values)
{
    std::vector<Imath::half> halves;
    halves.reserve(values.size());
    for (const float value : values)
        halves.emplace_back(std::clamp(value, float(-HALF_MAX), float(HALF_MAX))); // leaves NaN as it is
    return halves;
}

/// @param values of the layer in the type that is stored
void insertLayer(const ExrLayer& layer, uint32_t width, const void* values, Imf::ChannelList& channels,
                 Imf::FrameBuffer& source)
{
    const Imf::PixelType type = layer.half ? Imf::HALF : Imf::FLOAT;
    const size_t bytes = layer.half ? sizeof(Imath::half) : sizeof(float);
    const size_t x_stride = layer.channels.size() * bytes;
    for (size_t i = 0; i < layer.channels.size(); ++i)
    {
        const std::string name = (layer.name.empty() ? "" : layer.name + ".") + layer.channels[i];
        channels.insert(name, Imf::Channel(type));
        // The library takes a char* for reading and writing alike; an output file only reads.
        char* base = const_cast<char*>(static_cast<const char*>(values)) + i * bytes;
        source.insert(name, Imf::Slice(type, base, x_stride, x_stride * width));
    }
}

/// The checksum of PNG chunks: CRC-32 (ISO 3309), bit by bit as texts are short.
uint32_t checksum(std::span<const uint8_t> bytes)
{
    uint32_t crc = ~0u;
    for (const uint8_t byte : bytes)
    {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

std::vector<uint8_t> pngNoteChunks(std::span<const PictureNote> notes)
{
    std::vector<uint8_t> bytes;
    const auto append = [&](uint32_t number)
    {
        for (const int shift : {24, 16, 8, 0})
            bytes.push_back(uint8_t(number >> shift));
    };
    for (const PictureNote& note : notes)
    {
        append(uint32_t(note.name.size() + 1 + note.value.size()));
        const size_t checked = bytes.size();
        append(kPngText);
        bytes.insert(bytes.end(), note.name.begin(), note.name.end());
        bytes.push_back(0);
        bytes.insert(bytes.end(), note.value.begin(), note.value.end());
        append(checksum(std::span(bytes).subspan(checked)));
    }
    return bytes;
}

Status checkNoFolder(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ExitCode::kIo, "The output path is a folder; give a file name."};
    return Success{};
}
} // namespace

Status canWriteFile(const std::filesystem::path& path)
{
    if (const Status status = checkNoFolder(path); !status)
        return status;
    const TemporaryFile file(path);
    return file.isOpen() ? Status(Success{}) : cannotWrite("created");
}

Status writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes)
{
    if (const Status status = checkNoFolder(path); !status)
        return status;
    TemporaryFile file(path);
    if (!file.isOpen())
        return cannotWrite("created");
    if (!file.append(std::as_bytes(bytes)))
        return cannotWrite("written");
    if (!file.commit(Durability::kUntilPowerCut)) // whoever looks for pictures finds out whether they are whole
        return cannotWrite("put in place");
    return Success{};
}

Status writeExr(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const ExrLayer> layers,
                std::span<const PictureNote> notes)
{
    try
    {
        Imf::Header header{int(width), int(height)};
        header.compression() = Imf::ZIP_COMPRESSION;
        for (const PictureNote& note : notes)
            header.insert(note.name, Imf::StringAttribute(note.value));
        Imf::FrameBuffer source;
        std::vector<std::vector<Imath::half>> halves; // what slices point to
        for (const ExrLayer& layer : layers)
        {
            check(layer.values.size() == layer.channels.size() * width * height,
                  "layer '{}': {} x {} pixels with {} floats", layer.name, width, height, layer.values.size());
            if (layer.half)
                halves.push_back(toHalf(layer.values));
            const void* values = layer.half ? static_cast<const void*>(halves.back().data()) : layer.values.data();
            insertLayer(layer, width, values, header.channels(), source);
        }
        Imf::StdOSStream stream;
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(source);
            file.writePixels(int(height));
        } // its destructor writes the line offset table
        const std::string bytes = stream.str();
        return writeFile(path, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    }
    catch (const std::exception& problem)
    {
        return Error{ExitCode::kDevice, fmt::format("The image cannot be encoded as OpenEXR: {}.", problem.what())};
    }
}

Status writeExr(const std::filesystem::path& path, const ImageF& image, std::span<const PictureNote> notes)
{
    check(image.width > 0 && image.height > 0, "{} x {} pixels", image.width, image.height);
    const ExrLayer layer{.name = "", .channels = "RGB", .values = image.rgb};
    return writeExr(path, image.width, image.height, {&layer, 1}, notes);
}

std::vector<uint8_t> encodePng(uint32_t width, uint32_t height, uint32_t channel_count, std::span<const uint8_t> texels,
                               std::span<const PictureNote> notes)
{
    check(channel_count >= 1 && channel_count <= 4 && texels.size() == size_t(width) * height * channel_count,
          "{} x {} pixels, {} channels, {} bytes", width, height, channel_count, texels.size());
    std::vector<uint8_t> bytes;
    const auto append = [](void* sink, void* data, int size)
    {
        const auto* first = static_cast<const uint8_t*>(data);
        auto& out = *static_cast<std::vector<uint8_t>*>(sink);
        out.insert(out.end(), first, first + size);
    };
    const int written = stbi_write_png_to_func(append, &bytes, int(width), int(height), int(channel_count),
                                               texels.data(), int(width * channel_count));
    check(written != 0, "PNG encoder failed on {} x {} pixels", width, height);
    const std::vector<uint8_t> chunks = pngNoteChunks(notes);
    bytes.insert(bytes.begin() + kPngMagic.size() + kPngChunkOverhead + kPngHeaderBytes, chunks.begin(), chunks.end());
    return bytes;
}

Status writePng(const std::filesystem::path& path, uint32_t width, uint32_t height, uint32_t channel_count,
                std::span<const uint8_t> texels, std::span<const PictureNote> notes)
{
    return writeFile(path, encodePng(width, height, channel_count, texels, notes));
}

uint8_t srgbByte(float linear)
{
    if (!(linear > 0.0f))
        return 0;
    if (linear >= 1.0f)
        return 255;
    const float encoded = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
    return uint8_t(encoded * 255.0f + 0.5f);
}
