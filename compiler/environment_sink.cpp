#include "compiler/environment_sink.h"

#include "compiler/environment_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

Status EnvironmentSink::begin(const PictureInfo& picture)
{
    info = picture;
    image.width = info.width;
    image.height = info.height;
    if (info.cube)
    {
        constexpr uint32_t kMaxFace = 4096;
        if (info.width > kMaxFace)
            return Error{ExitCode::kUnsupported,
                         fmt::format("the cube map has faces of {} pixels a side, at most {} are read; reduce it",
                                     info.width, kMaxFace)};
    }
    else
    {
        image.width = std::min(info.width, kMaxEnvironmentWidth);
        image.height = std::min(info.height, kMaxEnvironmentHeight);
        reduced_ = image.width != info.width || image.height != info.height;
        if (reduced_)
        {
            columns_ = coverAxis(info.width, image.width, [](double u) { return u; });
            rows_ = coverAxis(info.height, image.height, [](double v) { return -std::cos(std::numbers::pi * v); });
        }
    }
    image.texels.assign(size_t(image.width) * image.height, {0, 0, 0, 1});
    return Success{};
}

float EnvironmentSink::repaired(float value, Repairs& pixel) const
{
    constexpr float kMostOfAHalf = 65504;
    constexpr float kMost = std::numeric_limits<float>::max();
    if (std::isnan(value))
    {
        ++pixel.not_a_number;
        return 0;
    }
    if (value < 0)
    {
        ++pixel.negative;
        return 0;
    }
    if (std::isinf(value))
    {
        ++pixel.infinite;
        value = kMostOfAHalf;
    }
    return std::min(value * scale_, kMost);
}

void EnvironmentSink::add(const ScanLine& line)
{
    const auto put = [&](uint32_t x, uint32_t y, const gpu::vec3& rgb, float weight)
    {
        gpu::vec4& texel = image.texels[size_t(y) * image.width + x];
        texel.x += weight * rgb.x;
        texel.y += weight * rgb.y;
        texel.z += weight * rgb.z;
    };
    forEachPixel(
        line,
        [&](uint32_t x, uint32_t y, const float* stored)
        {
            Repairs pixel;
            const gpu::vec3 rgb{repaired(stored[0], pixel), repaired(stored[1], pixel), repaired(stored[2], pixel)};
            repairs.not_a_number += pixel.not_a_number > 0;
            repairs.infinite += pixel.infinite > 0;
            repairs.negative += pixel.negative > 0;
            if (!reduced_)
            {
                image.texels[size_t(y) * image.width + x] = {rgb.x, rgb.y, rgb.z, 1};
                return;
            }
            const Coverage& column = columns_[x];
            const Coverage& row = rows_[y];
            put(column.first, row.first, rgb, column.in_first * row.in_first);
            if (column.in_second > 0)
                put(column.first + 1, row.first, rgb, column.in_second * row.in_first);
            if (row.in_second > 0)
                put(column.first, row.first + 1, rgb, column.in_first * row.in_second);
            if (column.in_second > 0 && row.in_second > 0)
                put(column.first + 1, row.first + 1, rgb, column.in_second * row.in_second);
        });
}
