// Whether a picture on the disk is whole, told without decoding its pixels.
#pragma once
#include <cstdint>
#include <filesystem>

enum class PictureState
{
    kNone,       // nothing has that name
    kIncomplete, // it begins like such a picture and ends too early, or is empty
    kWhole,      // it is such a picture up to its last pixels
    kOther,      // it is something else, has another size, or cannot be read
};

/// Of the PNG or OpenEXR file (by its extension) of width x height pixels that writePng() or writeExr() puts there.
/// Bytes that are wrong in between do not show.
PictureState pictureState(const std::filesystem::path& path, uint32_t width, uint32_t height);
