#include "compiler/environment_files.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>

namespace
{
Error invalid(std::string message)
{
    return {ExitCode::kInvalid, std::move(message)};
}

/// The channels to read as red, green and blue: RGB, or Y three times.
Result<std::array<std::string, 3>> chooseChannels(const Imf::ChannelList& channels)
{
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
        return std::array<std::string, 3>{"R", "G", "B"};
    if (channels.findChannel("RY") || channels.findChannel("BY"))
        return Error{ExitCode::kUnsupported,
                     "the EXR image stores luminance and chroma (Y, RY, BY); convert it to RGB first"};
    if (channels.findChannel("Y"))
        return std::array<std::string, 3>{"Y", "Y", "Y"};
    return invalid("the EXR image has neither channels R, G, B nor a channel Y");
}

void describe(Imf::FrameBuffer& frame, const std::array<std::string, 3>& channels, const Imath::Box2i& window,
              EnvironmentImage& image)
{
    constexpr size_t kTexel = sizeof(gpu::vec4);
    const size_t row = kTexel * image.width;
    constexpr std::array<size_t, 3> kOffsets{offsetof(gpu::vec4, x), offsetof(gpu::vec4, y), offsetof(gpu::vec4, z)};
    for (size_t i = 0; i < channels.size(); ++i)
    {
        if (i > 0 && channels[i] == channels[0])
            break; // a frame buffer names each channel once; the copy follows
        // OpenEXR addresses texels from the window's origin, which need not be 0.
        char* base = reinterpret_cast<char*>(image.texels.data()) + kOffsets[i] -
                     ptrdiff_t(window.min.x) * ptrdiff_t(kTexel) - ptrdiff_t(window.min.y) * ptrdiff_t(row);
        frame.insert(channels[i], Imf::Slice(Imf::FLOAT, base, kTexel, row));
    }
}

Result<EnvironmentImage> readPart(const std::filesystem::path& path)
{
    Imf::MultiPartInputFile file(path.c_str());
    const Imf::Header& header = file.header(0);
    if (header.hasType() && !Imf::isImage(header.type()))
        return Error{ExitCode::kUnsupported, "the EXR image has deep pixels; flatten it first"};
    const Result<std::array<std::string, 3>> channels = chooseChannels(header.channels());
    if (!channels)
        return channels.error();
    for (const std::string& name : *channels)
    {
        const Imf::Channel& channel = header.channels()[name];
        if (channel.xSampling != 1 || channel.ySampling != 1)
            return Error{ExitCode::kUnsupported, "the EXR image has subsampled channels; convert it first"};
    }

    const Imath::Box2i window = header.dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > kMaxEnvironmentSide || height > kMaxEnvironmentSide)
        return invalid(
            fmt::format("the EXR image is {} x {} texels, allowed are 1 to {}", width, height, kMaxEnvironmentSide));

    EnvironmentImage image{.width = uint32_t(width), .height = uint32_t(height), .texels = {}};
    image.texels.resize(size_t(width * height));
    Imf::FrameBuffer frame;
    describe(frame, *channels, window, image);
    Imf::InputPart part(file, 0);
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    if ((*channels)[1] == (*channels)[0])
    {
        for (gpu::vec4& texel : image.texels)
            texel.y = texel.z = texel.x;
    }
    return image;
}
} // namespace

Result<EnvironmentImage> readExr(const std::filesystem::path& path)
{
    try
    {
        return readPart(path);
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "there is not enough memory to read the EXR image"};
    }
    catch (const std::exception& e)
    {
        const std::string reason = e.what();
        return invalid(fmt::format("the EXR image cannot be read: {}", reason.substr(0, reason.find('\n'))));
    }
}
