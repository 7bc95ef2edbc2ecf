// A sink that stores the whole picture and the notes about it.
#pragma once
#include "image/image.h"
#include "image/picture.h"

#include <algorithm>

struct Collected : PictureSink
{
    ImageF image;
    PictureInfo info;

    Status begin(const PictureInfo& picture) override
    {
        info = picture;
        if (uint64_t(info.width) * info.height > 1 << 22) // no test's picture, but a damaged one's
            return Error{ExitCode::kDevice, "the picture is too large for a test"};
        image = {info.width, info.height, std::vector<float>(3 * size_t(info.width) * info.height)};
        return Success{};
    }
    void add(const ScanLine& line) override
    {
        forEachPixel(line, [&](uint32_t x, uint32_t y, const float* rgb)
                     { std::copy_n(rgb, 3, &image.rgb.at(3 * (size_t(y) * image.width + x))); });
    }
    const float* at(uint32_t x, uint32_t y) const { return &image.rgb.at(3 * (size_t(y) * image.width + x)); }
};
