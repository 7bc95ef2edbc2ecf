// Sums of samples in a picture's file, exact, so that parts of a picture add up to the same bytes however it was split.
#pragma once
#include "image/picture_origin.h"

#include <cstdint>
#include <filesystem>
#include <span>

__extension__ typedef __int128 Int128;

/// Samples first to last of every pixel, both included.
struct SampleRange
{
    uint32_t first = 0, last = 0;
};

struct SampleSum
{
    uint32_t width = 0, height = 0;
    std::vector<Int128> sums;         // [3 * width * height] R, G, B, in units of 2^-64 W/(m^2 sr), row 0 on top
    std::vector<SampleRange> samples; // that were summed: ascending, apart from each other
    PictureOrigin origin;             // its `samples` are those

    uint64_t sampleCount() const;
};

/// Writes the mean as R, G, B, and the sums as layers sum0, sum1, ... whose values add up to them exactly: each is what those
/// before leave over, rounded to the nearest float. The origin is in the header, with the samples.
Status writeSampleSum(const std::filesystem::path& path, const SampleSum& sum);

/// @return kInvalid where the file is something else, kIo where it cannot be opened
Result<SampleSum> readSampleSum(const std::filesystem::path& path);

/// Adds `part` to `sum`. @return kInvalid where it is not a part of the same picture, or has samples that are there already
Status addSamples(SampleSum& sum, const SampleSum& part);

/// "0-15,32-47"
std::string samplesText(std::span<const SampleRange> samples);
