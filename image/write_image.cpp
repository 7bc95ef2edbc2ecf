#include "image/write_image.h"

#include "format/check.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <half.h>
#include <stb_image_write.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <unistd.h>

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

} // namespace

Status writeFile(const std::filesystem::path& path, std::span<const uint8_t> bytes)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ExitCode::kIo, "The output path is a folder; give a file name."};

    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}.tmp", ::getpid());
    std::FILE* file = std::fopen(temporary.c_str(), "wb");
    if (!file)
        return cannotWrite("created");
    bool good = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    good = std::fflush(file) == 0 && good;
    const int write_error = errno;
    good = std::fclose(file) == 0 && good;
    if (!good)
    {
        const Error error{ExitCode::kIo, fmt::format("The file cannot be written: {}.", std::strerror(write_error))};
        std::filesystem::remove(temporary, ignored);
        return error;
    }
    if (std::rename(temporary.c_str(), path.c_str()) != 0)
    {
        const Error error = cannotWrite("put in place");
        std::filesystem::remove(temporary, ignored);
        return error;
    }
    return Success{};
}

Status writeExr(const std::filesystem::path& path, uint32_t width, uint32_t height, std::span<const ExrLayer> layers)
{
    try
    {
        Imf::Header header{int(width), int(height)};
        header.compression() = Imf::ZIP_COMPRESSION;
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

Status writeExr(const std::filesystem::path& path, const ImageF& image)
{
    check(image.width > 0 && image.height > 0, "{} x {} pixels", image.width, image.height);
    const ExrLayer layer{.name = "", .channels = "RGB", .values = image.rgb};
    return writeExr(path, image.width, image.height, {&layer, 1});
}

std::vector<uint8_t> encodePng(uint32_t width, uint32_t height, uint32_t channel_count, std::span<const uint8_t> texels)
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
    return bytes;
}

Status writePng(const std::filesystem::path& path, uint32_t width, uint32_t height, uint32_t channel_count,
                std::span<const uint8_t> texels)
{
    return writeFile(path, encodePng(width, height, channel_count, texels));
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
