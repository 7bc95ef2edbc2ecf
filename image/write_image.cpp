#include "image/write_image.h"

#include "format/check.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <stb_image_write.h>

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

Status writeExr(const std::filesystem::path& path, const ImageF& image)
{
    check(image.width > 0 && image.height > 0 && image.rgb.size() == 3 * image.pixelCount(),
          "{} x {} pixels with {} floats", image.width, image.height, image.rgb.size());
    try
    {
        Imf::Header header(int(image.width), int(image.height));
        header.compression() = Imf::ZIP_COMPRESSION;
        Imf::FrameBuffer source;
        const size_t x_stride = 3 * sizeof(float);
        for (size_t i = 0; i < 3; ++i)
        {
            const char name[2] = {"RGB"[i], '\0'};
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
            // The library takes a char* for reading and writing alike; an output file only reads.
            char* base = reinterpret_cast<char*>(const_cast<float*>(image.rgb.data() + i));
            source.insert(name, Imf::Slice(Imf::FLOAT, base, x_stride, x_stride * image.width));
        }
        Imf::StdOSStream stream;
        {
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(source);
            file.writePixels(int(image.height));
        } // its destructor writes the line offset table
        const std::string bytes = stream.str();
        return writeFile(path, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
    }
    catch (const std::exception& problem)
    {
        return Error{ExitCode::kDevice, fmt::format("The image cannot be encoded as OpenEXR: {}.", problem.what())};
    }
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
