#include "tools/image/read_exr.h"

#include <ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfTestFile.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>

namespace
{

constexpr uint64_t kMaxPixels = uint64_t(1) << 28;

/// Tells "cannot be opened" (and why) apart from "is not OpenEXR", which the library does not.
Status checkReadable(const std::filesystem::path& path)
{
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored))
        return Error{ExitCode::kIo, "The path is a folder; give an OpenEXR file."};
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file)
        return Error{ExitCode::kIo, fmt::format("The file cannot be opened: {}.", std::strerror(errno))};
    if (!Imf::isOpenExrFile(path.c_str()))
        return Error{ExitCode::kInvalid, "The file is not an OpenEXR image; give a .exr file."};
    return Success{};
}

std::string channelNames(const Imf::ChannelList& channels)
{
    std::string names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names += (names.empty() ? "" : ", ") + std::string(channel.name());
    return names;
}

/// Which channel goes into red, green and blue.
Result<std::vector<std::string>> pickChannels(const Imf::ChannelList& channels)
{
    std::vector<std::string> picked;
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
        picked = {"R", "G", "B"};
    else if (channels.findChannel("Y") && !channels.findChannel("RY") && !channels.findChannel("BY"))
        picked = {"Y", "Y", "Y"};
    else
        return Error{ExitCode::kUnsupported,
                     fmt::format("The image has the channels {}; channels R, G and B, or Y alone, "
                                 "are needed.",
                                 channelNames(channels))};
    for (const std::string& name : picked)
    {
        const Imf::Channel* channel = channels.findChannel(name);
        if (channel->xSampling != 1 || channel->ySampling != 1)
            return Error{ExitCode::kUnsupported,
                         fmt::format("Channel {} is sub-sampled; save the image with full-resolution channels.", name)};
    }
    return picked;
}

Result<ImageF> readPixels(Imf::InputFile& file)
{
    const Imath::Box2i window = file.header().dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1)
        return Error{ExitCode::kInvalid, "The image's data window is empty; save it again."};
    if (uint64_t(width) * uint64_t(height) > kMaxPixels)
        return Error{ExitCode::kUnsupported,
                     fmt::format("The image has {} x {} pixels; at most 2^28 are read.", width, height)};

    const Result<std::vector<std::string>> picked = pickChannels(file.header().channels());
    if (!picked)
        return picked.error();

    ImageF image{uint32_t(width), uint32_t(height), {}};
    image.rgb.resize(3 * image.pixelCount());
    const size_t x_stride = 3 * sizeof(float);
    const size_t y_stride = x_stride * size_t(width);
    Imf::FrameBuffer target;
    const bool grey = (*picked)[0] == (*picked)[1];
    for (size_t i = 0; i < (grey ? 1u : 3u); ++i)
        target.insert((*picked)[i], Imf::Slice::Make(Imf::FLOAT, image.rgb.data() + i, window, x_stride, y_stride));
    file.setFrameBuffer(target);
    file.readPixels(window.min.y, window.max.y);
    if (grey)
        for (size_t i = 0; i < image.rgb.size(); i += 3)
            image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
    return image;
}

} // namespace

Result<ImageF> readExr(const std::filesystem::path& path)
{
    if (const Status readable = checkReadable(path); !readable)
        return readable.error();
    try
    {
        Imf::InputFile file(path.c_str());
        return readPixels(file);
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "There is not enough memory for this image."};
    }
    catch (const std::exception& problem)
    {
        return Error{ExitCode::kInvalid,
                     fmt::format("The OpenEXR file is damaged or incomplete ({}); write it again.", problem.what())};
    }
}
