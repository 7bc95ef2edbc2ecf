#include "image/exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>

namespace
{
/// "left.diffuse." of "left.diffuse.R", "" of "R".
std::string layerOf(const std::string& channel)
{
    return channel.substr(0, channel.rfind('.') + 1);
}

/// Layers in the file's order, which is alphabetical; "" is that of the channels without one and comes first.
std::vector<std::string> layersOf(const Imf::ChannelList& channels)
{
    std::vector<std::string> layers{""};
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
    {
        const std::string layer = layerOf(channel.name());
        if (std::find(layers.begin(), layers.end(), layer) == layers.end())
            layers.push_back(layer);
    }
    return layers;
}

/// The colour of one layer; no names where it has none.
ExrChannels colourOf(const Imf::ChannelList& channels, const std::string& layer)
{
    const auto has = [&](const char* name) { return channels.findChannel(layer + name) != nullptr; };
    if (has("R") && has("G") && has("B"))
        return {.colour = ExrColour::kRgb, .names = {layer + "R", layer + "G", layer + "B"}, .notes = {}};
    if (has("Y") && has("RY") && has("BY"))
        return {.colour = ExrColour::kLuminanceChroma, .names = {layer + "Y", layer + "RY", layer + "BY"}, .notes = {}};
    if (has("Y"))
        return {.colour = ExrColour::kGrey, .names = {layer + "Y"}, .notes = {}};
    return {};
}

std::string withoutDot(const std::string& layer)
{
    return layer.substr(0, layer.size() - 1);
}

/// The first layer with colour, with a note where there are several or where it has a name.
ExrChannels chooseLayer(const Imf::ChannelList& channels)
{
    std::vector<std::string> coloured;
    for (const std::string& layer : layersOf(channels))
        if (!colourOf(channels, layer).names.empty())
            coloured.push_back(layer);
    if (coloured.empty())
        return {};
    ExrChannels chosen = colourOf(channels, coloured.front());
    if (coloured.size() > 1 || !coloured.front().empty())
        chosen.notes.push_back(
            coloured.front().empty()
                ? fmt::format("the EXR image has {} layers with colour: its channels without a layer are read",
                              coloured.size())
                : fmt::format("the EXR image has layers: of {} with colour \"{}\" is read", coloured.size(),
                              withoutDot(coloured.front())));
    return chosen;
}

bool isDeep(const Imf::Header& header)
{
    return header.hasType() && !Imf::isImage(header.type());
}

std::string channelNames(const Imf::MultiPartInputFile& file)
{
    std::string names;
    constexpr size_t kEnough = 200; // characters
    for (int part = 0; part < file.parts(); ++part)
        for (auto channel = file.header(part).channels().begin();
             channel != file.header(part).channels().end() && names.size() < kEnough; ++channel)
            names += (names.empty() ? "" : ", ") + std::string(channel.name());
    return names;
}
} // namespace

Result<ExrChannels> chooseExrChannels(const Imf::MultiPartInputFile& file)
{
    int deep = 0;
    for (int part = 0; part < file.parts(); ++part)
    {
        const Imf::Header& header = file.header(part);
        deep += isDeep(header);
        if (isDeep(header))
            continue;
        ExrChannels chosen = chooseLayer(header.channels());
        if (chosen.names.empty())
            continue;
        chosen.part = part;
        if (file.parts() > 1)
            chosen.notes.push_back(fmt::format("the EXR image has {} parts: part {} is read{}", file.parts(), part,
                                               header.hasName() ? fmt::format(", \"{}\"", header.name()) : ""));
        return chosen;
    }
    if (deep > 0)
        return Error{ExitCode::kUnsupported, "the EXR image has deep pixels; flatten it first"};
    return Error{ExitCode::kInvalid,
                 fmt::format("the EXR image has neither channels R, G, B nor a channel Y, but the channels {}",
                             channelNames(file))};
}
