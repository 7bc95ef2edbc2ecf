// OpenEXR files for tests, in every way a picture may be stored.
#pragma once
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfTileDescription.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

struct ExrChannel
{
    std::string name;
    std::function<float(int x, int y)> value; // at a pixel of the data window
    int sampling = 1;                         // both ways
    bool half = false;
};

struct ExrPart
{
    Imath::Box2i data, display;
    std::vector<ExrChannel> channels;
    Imf::Compression compression = Imf::ZIP_COMPRESSION;
    std::optional<Imf::TileDescription> tiles{}; // levels above 0 hold 77 everywhere
    std::optional<Imf::Chromaticities> chromaticities{};
    std::optional<Imf::Envmap> envmap{};
    std::string text_envmap{}; // an attribute "envmap" of another type
    std::string name{};        // needed of several parts
    bool deep = false;         // scan lines without samples
};

/// One part makes a single-part file.
std::vector<std::byte> writeExr(const std::vector<ExrPart>& parts);

/// Windows from (x, y), of `width` x `height` pixels.
inline Imath::Box2i window(int x, int y, int width, int height)
{
    return {{x, y}, {x + width - 1, y + height - 1}};
}

/// R, G, B of `value` times 1, 2 and 4.
std::vector<ExrChannel> rgbChannels(const std::function<float(int x, int y)>& value, const std::string& layer = "");
