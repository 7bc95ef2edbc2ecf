#include "compiler/environment.h"

#include "compiler/vector_math.h"
#include "format/alias_table.h"
#include "format/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace
{
constexpr double kPi = std::numbers::pi;

/// The fraction of the sphere's 4 pi that one texel in `row` of a `width` x `height` map covers.
double solidAngleFraction(uint32_t width, uint32_t height, uint32_t row)
{
    return (std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height)) / (2.0 * width);
}

/// How much of texel `index`'s bilinear weight (a tent of width 2 about its centre) lies in [from, to]; texel units.
double tentIntegral(double index, double from, double to)
{
    const auto primitive = [](double x)
    {
        x = std::clamp(x, -1.0, 1.0);
        return x < 0 ? (1 + x) * (1 + x) / 2 : 1 - (1 - x) * (1 - x) / 2;
    };
    return primitive(to - index - 0.5) - primitive(from - index - 0.5);
}

/// Means of a bilinearly filtered signal over `cells` equal parts.
/// @param value value(i) of sample i, -1 <= i <= count: the caller repeats or clamps at the ends
template <typename Value, typename Store>
void filterLine(uint32_t count, uint32_t cells, const Value& value, const Store& store)
{
    const double step = double(count) / cells;
    for (uint32_t cell = 0; cell < cells; ++cell)
    {
        const double from = cell * step;
        const double to = from + step;
        double sum = 0;
        for (int64_t i = int64_t(std::floor(from - 0.5)); double(i) - 0.5 < to; ++i)
            sum += tentIntegral(double(i), from, to) * value(std::clamp<int64_t>(i, -1, count));
        store(cell, sum / step);
    }
}

/// Mean filtered luminance of every importance cell, row-major.
std::vector<double> filteredLuminance(const EnvironmentImage& image, uint32_t width, uint32_t height)
{
    std::vector<double> rows(size_t(width) * image.height); // filtered in u only
    for (uint32_t y = 0; y < image.height; ++y)
    {
        const gpu::vec4* row = image.texels.data() + size_t(y) * image.width;
        const auto value = [&](int64_t i)
        {
            const gpu::vec4& texel = row[(i + image.width) % image.width];
            return double(luminance({texel.x, texel.y, texel.z}));
        };
        filterLine(image.width, width, value, [&](uint32_t x, double mean) { rows[size_t(y) * width + x] = mean; });
    }
    std::vector<double> cells(size_t(width) * height);
    for (uint32_t x = 0; x < width; ++x)
    {
        const auto value = [&](int64_t i)
        { return rows[size_t(std::clamp<int64_t>(i, 0, image.height - 1)) * width + x]; };
        filterLine(image.height, height, value, [&](uint32_t y, double mean) { cells[size_t(y) * width + x] = mean; });
    }
    return cells;
}
} // namespace

EnvironmentImage defaultSky()
{
    EnvironmentImage sky{.width = 256, .height = 128, .texels = {}};
    const gpu::vec3 zenith{0.35f, 0.55f, 1.0f};
    const gpu::vec3 horizon{0.80f, 0.85f, 0.90f};
    const gpu::vec3 ground{0.22f, 0.19f, 0.16f};
    for (uint32_t row = 0; row < sky.height; ++row)
    {
        const float y =
            std::cos(std::numbers::pi_v<float> * (float(row) + 0.5f) / float(sky.height)); // sine of altitude
        const float rise = std::sqrt(std::max(y, 0.0f));
        const gpu::vec3 above = horizon * (1 - rise) + zenith * rise;
        const float blend = std::clamp(0.5f + y / 0.1f, 0.0f, 1.0f); // a soft horizon of about six degrees
        const gpu::vec3 radiance = ground * (1 - blend) + above * blend;
        sky.texels.insert(sky.texels.end(), sky.width, {radiance.x, radiance.y, radiance.z, 1});
    }
    return sky;
}

PunctualLight defaultSun()
{
    const gpu::vec3 towards_sun{0.45f, 0.80f, 0.35f};
    return {.kind = gpu::kLightDirectional,
            .direction = towards_sun * (-1 / length(towards_sun)),
            .intensity = {10.0f, 9.0f, 7.5f}};
}

gpu::vec3 averageRadiance(const EnvironmentImage& image)
{
    std::array<double, 3> sum{};
    for (uint32_t row = 0; row < image.height; ++row)
    {
        const double fraction = solidAngleFraction(image.width, image.height, row);
        for (uint32_t column = 0; column < image.width; ++column)
        {
            const gpu::vec4& texel = image.texels[size_t(row) * image.width + column];
            sum[0] += fraction * texel.x;
            sum[1] += fraction * texel.y;
            sum[2] += fraction * texel.z;
        }
    }
    return {float(sum[0]), float(sum[1]), float(sum[2])};
}

EnvironmentImportance buildImportance(const EnvironmentImage& image)
{
    check(image.width > 0 && image.height > 0 && image.texels.size() == size_t(image.width) * image.height,
          "{} x {}, {} texels", image.width, image.height, image.texels.size());
    EnvironmentImportance importance{.width = std::min(image.width, 1024u),
                                     .height = std::min(image.height, 512u),
                                     .texels = {},
                                     .average_radiance = averageRadiance(image)};
    std::vector<double> weights = filteredLuminance(image, importance.width, importance.height);
    double total = 0;
    for (size_t i = 0; i < weights.size(); ++i)
        total += weights[i] *= solidAngleFraction(importance.width, importance.height, uint32_t(i / importance.width));
    if (total == 0) // a black map: any valid distribution will do
        std::fill(weights.begin(), weights.end(), total = 1.0);
    // However dark relative to the rest, texels that emit need a probability that single precision can divide by.
    for (double& weight : weights)
        weight = weight > 0 ? std::max(weight, total * 1e-12) : 0;
    total = std::accumulate(weights.begin(), weights.end(), 0.0);

    const std::vector<gpu::AliasEntry> table = buildAliasTable(weights);
    for (size_t i = 0; i < table.size(); ++i)
        importance.texels.push_back({table[i].threshold, table[i].alias, float(weights[i] / total)});
    return importance;
}
