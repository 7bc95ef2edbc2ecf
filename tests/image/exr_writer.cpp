#include "tests/image/exr_writer.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputPart.h>

#include <bit>

namespace
{
Imf::Header headerOf(const ExrPart& part)
{
    Imf::Header header(part.display, part.data);
    header.compression() = part.deep ? Imf::ZIPS_COMPRESSION : part.compression;
    for (const ExrChannel& channel : part.channels)
        header.channels().insert(
            channel.name, Imf::Channel(channel.half ? Imf::HALF : Imf::FLOAT, channel.sampling, channel.sampling));
    if (part.tiles)
        header.setTileDescription(*part.tiles);
    if (part.chromaticities)
        Imf::addChromaticities(header, *part.chromaticities);
    if (part.envmap)
        Imf::addEnvmap(header, *part.envmap);
    if (!part.text_envmap.empty())
        header.insert("envmap", Imf::StringAttribute(part.text_envmap));
    header.setType(part.deep ? Imf::DEEPSCANLINE : part.tiles ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
    header.setName(part.name.empty() ? "picture" : part.name);
    return header;
}

/// Values of the channels over `box`, and a frame buffer that points at them.
struct Planes
{
    std::vector<std::vector<float>> floats;
    std::vector<std::vector<half>> halfs;
    Imf::FrameBuffer frame;

    template <typename Value>
    Planes(const std::vector<ExrChannel>& channels, const Imath::Box2i& box, const Value& value)
    {
        floats.resize(channels.size());
        halfs.resize(channels.size());
        for (size_t i = 0; i < channels.size(); ++i)
        {
            const ExrChannel& channel = channels[i];
            const int step = channel.sampling, columns = (box.max.x - box.min.x) / step + 1;
            for (int y = box.min.y; y <= box.max.y; y += step)
                for (int x = box.min.x; x <= box.max.x; x += step)
                {
                    floats[i].push_back(value(channel, x, y));
                    halfs[i].push_back(half(floats[i].back()));
                }
            const size_t size = channel.half ? sizeof(half) : sizeof(float);
            const auto first =
                channel.half ? std::bit_cast<uintptr_t>(halfs[i].data()) : std::bit_cast<uintptr_t>(floats[i].data());
            const auto base =
                first - uintptr_t((int64_t(box.min.y / step) * columns + box.min.x / step) * int64_t(size));
            frame.insert(channel.name, Imf::Slice(channel.half ? Imf::HALF : Imf::FLOAT, std::bit_cast<char*>(base),
                                                  size, size * size_t(columns), step, step));
        }
    }
};

void writeLevels(Imf::TiledOutputPart& out, const ExrPart& part)
{
    for (int ly = 0; ly < out.numYLevels(); ++ly)
        for (int lx = 0; lx < out.numXLevels(); ++lx)
        {
            if (!out.isValidLevel(lx, ly))
                continue;
            const Planes planes(part.channels, out.dataWindowForLevel(lx, ly),
                                [&](const ExrChannel& channel, int x, int y)
                                { return lx == 0 && ly == 0 ? channel.value(x, y) : 77.0f; });
            out.setFrameBuffer(planes.frame);
            out.writeTiles(0, out.numXTiles(lx) - 1, 0, out.numYTiles(ly) - 1, lx, ly);
        }
}

void writeEmptyLines(Imf::DeepScanLineOutputPart& out, const ExrPart& part)
{
    const Imath::Box2i& box = part.data;
    const int columns = box.max.x - box.min.x + 1, rows = box.max.y - box.min.y + 1;
    const std::vector<uint32_t> counts(size_t(columns * rows));
    const std::vector<float*> samples(counts.size());
    const auto base = [&](const void* first, int size)
    {
        return std::bit_cast<char*>(std::bit_cast<uintptr_t>(first) -
                                    uintptr_t(int64_t(box.min.y * columns + box.min.x) * size));
    };
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice(Imf::UINT, base(counts.data(), 4), 4, size_t(4 * columns)));
    for (const ExrChannel& channel : part.channels)
        frame.insert(channel.name, Imf::DeepSlice(Imf::FLOAT, base(samples.data(), sizeof(float*)), sizeof(float*),
                                                  sizeof(float*) * size_t(columns), sizeof(float)));
    out.setFrameBuffer(frame);
    out.writePixels(rows);
}
} // namespace

std::vector<std::byte> writeExr(const std::vector<ExrPart>& parts)
{
    std::vector<Imf::Header> headers;
    for (const ExrPart& part : parts)
        headers.push_back(headerOf(part));
    Imf::StdOSStream stream;
    {
        Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()));
        for (int i = 0; i < int(parts.size()); ++i)
        {
            const ExrPart& part = parts[size_t(i)];
            if (part.deep)
            {
                Imf::DeepScanLineOutputPart out(file, i);
                writeEmptyLines(out, part);
            }
            else if (part.tiles)
            {
                Imf::TiledOutputPart out(file, i);
                writeLevels(out, part);
            }
            else
            {
                Imf::OutputPart out(file, i);
                const Planes planes(part.channels, part.data,
                                    [](const ExrChannel& channel, int x, int y) { return channel.value(x, y); });
                out.setFrameBuffer(planes.frame);
                out.writePixels(part.data.max.y - part.data.min.y + 1);
            }
        }
    } // its destructor writes the offset tables
    const std::string text = stream.str();
    const auto* bytes = reinterpret_cast<const std::byte*>(text.data());
    return {bytes, bytes + text.size()};
}

std::vector<ExrChannel> rgbChannels(const std::function<float(int x, int y)>& value, const std::string& layer)
{
    return {{.name = layer + "R", .value = value},
            {.name = layer + "G", .value = [value](int x, int y) { return 2 * value(x, y); }},
            {.name = layer + "B", .value = [value](int x, int y) { return 4 * value(x, y); }}};
}
