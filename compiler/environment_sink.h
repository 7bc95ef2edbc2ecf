// Gathers a picture as the texels of an environment map.
#pragma once
#include "compiler/scene_data.h"
#include "image/picture.h"

/// Counts of pixels with invalid values.
struct Repairs
{
    uint64_t not_a_number = 0;
    uint64_t infinite = 0;
    uint64_t negative = 0;
};

/// Which of at most two map texels a pixel falls into along one axis, and the fraction of each texel that it covers.
struct Coverage
{
    uint32_t first = 0;
    float in_first = 1;
    float in_second = 0;
};

/// [pixels] of an axis that is cut into `texels` <= `pixels` equal parts, weighted by the measure from 0 to `position`
/// that `measure` gives, in units of the axis' length.
template <typename Measure>
std::vector<Coverage> coverAxis(uint32_t pixels, uint32_t texels, const Measure& measure)
{
    std::vector<Coverage> coverage(pixels);
    for (uint32_t i = 0; i < pixels; ++i)
    {
        if (pixels == texels)
        {
            coverage[i].first = i;
            continue;
        }
        const auto first = uint32_t(uint64_t(i) * texels / pixels);
        const auto size = [&](uint32_t texel)
        { return measure(double(texel + 1) / texels) - measure(double(texel) / texels); };
        const double low = double(i) / pixels, high = double(i + 1) / pixels;
        const bool crosses = uint64_t(i + 1) * texels > uint64_t(first + 1) * pixels;
        const double edge = crosses ? double(first + 1) / texels : high;
        coverage[i] = {first, float((measure(edge) - measure(low)) / size(first)),
                       crosses ? float((measure(high) - measure(edge)) / size(first + 1)) : 0.0f};
    }
    return coverage;
}

class EnvironmentSink : public PictureSink
{
public:
    explicit EnvironmentSink(float scale) : scale_(scale) {}

    Status begin(const PictureInfo& info) override;
    void add(const ScanLine& line) override;

    PictureInfo info;
    EnvironmentImage image; // of a cube: its faces below each other, as they came
    Repairs repairs;

private:
    /// One channel, made valid. @return its replacement
    float repaired(float value, Repairs& pixel) const;

    float scale_;
    bool reduced_ = false;
    std::vector<Coverage> columns_, rows_;
};
