// Which channels of which part of an OpenEXR file are its picture.
#pragma once
#include "format/result.h"

#include <OpenEXR/ImfMultiPartInputFile.h>

#include <string>
#include <vector>

enum class ExrColour
{
    kRgb,
    kGrey,            // Y
    kLuminanceChroma, // Y, RY = (R - Y) / Y, BY = (B - Y) / Y
};

struct ExrChannels
{
    int part = 0;
    ExrColour colour = ExrColour::kRgb;
    std::vector<std::string> names; // full ones, in the order R, G, B or Y, RY, BY
    std::vector<std::string> notes; // of what was chosen where there was a choice
};

/// The first part with colour; in it the channels without a layer, else those of the first layer that has colour.
/// @return kInvalid naming the channels where there is no colour, kUnsupported where there are only deep pixels
Result<ExrChannels> chooseExrChannels(const Imf::MultiPartInputFile& file);
