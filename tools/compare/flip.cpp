#include "tools/compare/flip.h"

#include "format/check.h"
#include "tools/compare/flip_color.h"
#include "tools/compare/flip_filters.h"
#include "tools/compare/parallel_rows.h"

#include <cstring>

namespace
{

constexpr float kColorExponent = 0.7f;
constexpr float kColorKnee = 0.4f;    // of the largest colour distance ...
constexpr float kColorKneeTo = 0.95f; // ... is shown as this error
constexpr float kInverseSqrt2 = 0.707106781f;

using Plane = std::vector<float>; // [width * height]

using Lanes [[gnu::vector_size(16)]] = float;
constexpr uint32_t kLanes = 4;

Lanes load(const float* from)
{
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof(lanes));
    return lanes;
}

void store(Lanes lanes, float* to)
{
    std::memcpy(to, &lanes, sizeof(lanes));
}

/// out[i] (+)= sum over taps of weights[tap] * inputs[tap][i]. Left to itself the compiler does not vectorise this
/// well, and it is where the time goes: the sums of 16 neighbours stay in registers through all taps.
void weightedSum(const std::vector<const float*>& inputs, const Taps& taps, bool add, uint32_t count, float* out)
{
    const size_t tap_count = taps.weights.size();
    uint32_t i = 0;
    for (; i + 4 * kLanes <= count; i += 4 * kLanes)
    {
        Lanes a{}, b{}, c{}, d{};
        for (size_t tap = 0; tap < tap_count; ++tap)
        {
            const float* in = inputs[tap] + i;
            const float weight = taps.weights[tap];
            a += weight * load(in);
            b += weight * load(in + kLanes);
            c += weight * load(in + 2 * kLanes);
            d += weight * load(in + 3 * kLanes);
        }
        store(add ? a + load(out + i) : a, out + i);
        store(add ? b + load(out + i + kLanes) : b, out + i + kLanes);
        store(add ? c + load(out + i + 2 * kLanes) : c, out + i + 2 * kLanes);
        store(add ? d + load(out + i + 3 * kLanes) : d, out + i + 3 * kLanes);
    }
    for (; i < count; ++i)
    {
        float sum = 0;
        for (size_t tap = 0; tap < tap_count; ++tap)
            sum += taps.weights[tap] * inputs[tap][i];
        out[i] = add ? sum + out[i] : sum;
    }
}

/// A row with its edge values repeated outwards, so that filters need no bounds.
class PaddedRow
{
public:
    PaddedRow(uint32_t width, int padding) : width_(width), padding_(padding), values_(width + 2 * size_t(padding)) {}
    float* data() { return values_.data() + padding_; }
    void extend()
    {
        std::fill_n(values_.begin(), padding_, values_[size_t(padding_)]);
        std::fill_n(values_.end() - padding_, padding_, *(values_.end() - padding_ - 1));
    }
    void filter(const Taps& taps, float* out) const
    {
        std::vector<const float*> shifted(taps.weights.size());
        for (size_t i = 0; i < shifted.size(); ++i)
            shifted[i] = values_.data() + padding_ - taps.radius() + i;
        weightedSum(shifted, taps, false, width_, out);
    }

private:
    uint32_t width_;
    int padding_;
    std::vector<float> values_;
};

/// One image after filtering along its rows.
struct RowFiltered
{
    uint32_t width, height;
    Plane achromatic, red_green, blue_yellow[2]; // contrast
    Plane smooth, edge, point;                   // of the achromatic channel, 0..1

    RowFiltered(uint32_t w, uint32_t h) : width(w), height(h)
    {
        for (Plane* plane : {&achromatic, &red_green, &blue_yellow[0], &blue_yellow[1], &smooth, &edge, &point})
            plane->resize(size_t(w) * h);
    }
};

/// One row of one image after filtering in both directions.
struct FilteredRow
{
    std::vector<float> achromatic, red_green, blue_yellow, edge_x, edge_y, point_x, point_y;

    explicit FilteredRow(uint32_t width)
    {
        for (auto* row : {&achromatic, &red_green, &blue_yellow, &edge_x, &edge_y, &point_x, &point_y})
            row->resize(width);
    }
};

class Flip
{
public:
    Flip(uint32_t width, uint32_t height, float pixels_per_degree)
        : width_(width), height_(height), contrast_(contrastFilters(pixels_per_degree)),
          feature_(featureFilters(pixels_per_degree)), reference_(width, height), test_(width, height)
    {
        const Color green = huntLab({0, 1, 0});
        const Color blue = huntLab({0, 0, 1});
        color_max_ = std::pow(hyab(green, blue), kColorExponent);
    }

    /// Raises error[i] to the LDR-FLIP error of the two images, each value of which goes through `shown` first.
    template <typename Shown>
    void raise(const ImageF& reference, const ImageF& test, const Shown& shown, std::vector<float>& error)
    {
        parallelRows(height_,
                     [&](uint32_t first, uint32_t last)
                     {
                         filterRows(reference, shown, first, last, reference_);
                         filterRows(test, shown, first, last, test_);
                     });
        parallelRows(height_,
                     [&](uint32_t first, uint32_t last)
                     {
                         FilteredRow a(width_), b(width_);
                         for (uint32_t y = first; y < last; ++y)
                         {
                             filterColumns(reference_, y, a);
                             filterColumns(test_, y, b);
                             for (uint32_t x = 0; x < width_; ++x)
                             {
                                 float& largest = error[size_t(y) * width_ + x];
                                 largest = std::max(largest, pixelError(a, b, x));
                             }
                         }
                     });
    }

private:
    template <typename Shown>
    void filterRows(const ImageF& image, const Shown& shown, uint32_t first, uint32_t last, RowFiltered& out) const
    {
        const int padding = std::max({contrast_.blue_yellow[0].radius(), contrast_.blue_yellow[1].radius(),
                                      contrast_.achromatic.radius(), contrast_.red_green.radius(),
                                      feature_.smooth.radius(), feature_.edge.radius()});
        PaddedRow y_row(width_, padding), cx_row(width_, padding), cz_row(width_, padding), grey_row(width_, padding);
        for (uint32_t y = first; y < last; ++y)
        {
            const size_t offset = size_t(y) * width_;
            const float* rgb = image.rgb.data() + 3 * offset;
            for (uint32_t x = 0; x < width_; ++x, rgb += 3)
            {
                const Color c = ycxczFromRgb({shown(rgb[0]), shown(rgb[1]), shown(rgb[2])});
                y_row.data()[x] = c.x;
                cx_row.data()[x] = c.y;
                cz_row.data()[x] = c.z;
                grey_row.data()[x] = (c.x + 16.0f) * (1.0f / 116.0f);
            }
            for (PaddedRow* row : {&y_row, &cx_row, &cz_row, &grey_row})
                row->extend();
            y_row.filter(contrast_.achromatic, &out.achromatic[offset]);
            cx_row.filter(contrast_.red_green, &out.red_green[offset]);
            for (int i = 0; i < 2; ++i)
                cz_row.filter(contrast_.blue_yellow[i], &out.blue_yellow[i][offset]);
            grey_row.filter(feature_.smooth, &out.smooth[offset]);
            grey_row.filter(feature_.edge, &out.edge[offset]);
            grey_row.filter(feature_.point, &out.point[offset]);
        }
    }

    void filterColumn(const Plane& plane, const Taps& taps, uint32_t y, std::vector<float>& out, bool add = false) const
    {
        std::vector<const float*> rows(taps.weights.size());
        for (size_t i = 0; i < rows.size(); ++i)
        {
            const int row = std::clamp(int(y) + int(i) - taps.radius(), 0, int(height_) - 1);
            rows[i] = plane.data() + size_t(row) * width_;
        }
        weightedSum(rows, taps, add, width_, out.data());
    }

    void filterColumns(const RowFiltered& in, uint32_t y, FilteredRow& out) const
    {
        filterColumn(in.achromatic, contrast_.achromatic, y, out.achromatic);
        filterColumn(in.red_green, contrast_.red_green, y, out.red_green);
        filterColumn(in.blue_yellow[0], contrast_.blue_yellow[0], y, out.blue_yellow);
        filterColumn(in.blue_yellow[1], contrast_.blue_yellow[1], y, out.blue_yellow, true);
        filterColumn(in.edge, feature_.smooth, y, out.edge_x);
        filterColumn(in.smooth, feature_.edge, y, out.edge_y);
        filterColumn(in.point, feature_.smooth, y, out.point_x);
        filterColumn(in.smooth, feature_.point, y, out.point_y);
        // What the eye receives stays within the screen's gamut (section 4.1 of the LDR paper), then becomes Lab.
        toLab(out.achromatic.data(), out.red_green.data(), out.blue_yellow.data());
        toLength(out.edge_x.data(), out.edge_y.data());
        toLength(out.point_x.data(), out.point_y.data());
    }

    void toLab(float* __restrict a, float* __restrict b, float* __restrict c) const
    {
        const auto shown = [](float v) { return std::min(std::max(v, 0.0f), 1.0f); };
        for (uint32_t x = 0; x < width_; ++x)
        {
            const Color rgb = rgbFromYcxcz({a[x], b[x], c[x]});
            const Color lab = huntLab({shown(rgb.x), shown(rgb.y), shown(rgb.z)});
            a[x] = lab.x;
            b[x] = lab.y;
            c[x] = lab.z;
        }
    }

    /// x[i] = length of (x[i], y[i])
    void toLength(float* __restrict x, const float* __restrict y) const
    {
        for (uint32_t i = 0; i < width_; ++i)
            x[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
    }

    float pixelError(const FilteredRow& a, const FilteredRow& b, uint32_t x) const
    {
        const float distance = std::pow(hyab({a.achromatic[x], a.red_green[x], a.blue_yellow[x]},
                                             {b.achromatic[x], b.red_green[x], b.blue_yellow[x]}),
                                        kColorExponent);
        const float knee = kColorKnee * color_max_;
        const float color = distance < knee
                                ? distance * (kColorKneeTo / knee)
                                : kColorKneeTo + (distance - knee) / (color_max_ - knee) * (1 - kColorKneeTo);
        const float feature_distance =
            std::max(std::abs(a.edge_x[x] - b.edge_x[x]), std::abs(a.point_x[x] - b.point_x[x]));
        return std::pow(std::min(color, 1.0f), 1.0f - std::sqrt(kInverseSqrt2 * feature_distance));
    }

    uint32_t width_, height_;
    ContrastFilters contrast_;
    FeatureFilters feature_;
    RowFiltered reference_, test_;
    float color_max_ = 0;
};

void checkSizes(const ImageF& reference, const ImageF& test)
{
    check(reference.width == test.width && reference.height == test.height && reference.pixelCount() > 0,
          "{} x {} and {} x {}", reference.width, reference.height, test.width, test.height);
}

void setMean(FlipMap& map)
{
    double total = 0;
    for (float error : map.error)
        total += double(error);
    map.mean = total / double(map.error.size());
}

} // namespace

FlipMap ldrFlip(const ImageF& reference, const ImageF& test, float pixels_per_degree)
{
    checkSizes(reference, test);
    FlipMap map{std::vector<float>(reference.pixelCount(), 0.0f), 0};
    Flip flip(reference.width, reference.height, pixels_per_degree);
    flip.raise(
        reference, test, [](float v) { return std::clamp(v, 0.0f, 1.0f); }, map.error);
    setMean(map);
    return map;
}

FlipExposures flipExposures(const ImageF& reference)
{
    std::vector<float> luminance;
    luminance.reserve(reference.pixelCount());
    for (size_t i = 0; i < reference.rgb.size(); i += 3)
    {
        const auto positive = [&](size_t channel) { return std::max(reference.rgb[i + channel], 0.0f); };
        luminance.push_back(0.2126f * positive(0) + 0.7152f * positive(1) + 0.0722f * positive(2));
    }
    const auto upperMedian = [&]
    {
        const auto middle = luminance.begin() + std::ptrdiff_t(luminance.size() / 2);
        std::nth_element(luminance.begin(), middle, luminance.end());
        return *middle;
    };
    const float brightest = *std::max_element(luminance.begin(), luminance.end());
    if (brightest <= 0.0f)
        return {}; // a black reference: any exposure shows it alike
    float median = upperMedian();
    if (median <= 0.0f)
    {
        std::erase_if(luminance, [](float v) { return v <= 0.0f; });
        median = upperMedian();
    }

    // The x at which acesCurve(x) = 0.85: the larger root of a x^2 + b x + c = 0.
    constexpr double kTarget = 0.85;
    const double a = double(kAces[0]) - kTarget * double(kAces[3]);
    const double b = double(kAces[1]) - kTarget * double(kAces[4]);
    const double c = double(kAces[2]) - kTarget * double(kAces[5]);
    const double x = (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);

    FlipExposures exposures;
    exposures.start = float(std::log2(x / double(brightest)));
    exposures.stop = float(std::log2(x / double(median)));
    exposures.count = uint32_t(std::max(2.0f, std::ceil(exposures.stop - exposures.start)));
    return exposures;
}

FlipMap hdrFlip(const ImageF& reference, const ImageF& test, const FlipExposures& exposures, float pixels_per_degree)
{
    checkSizes(reference, test);
    check(exposures.count >= 2 && exposures.start <= exposures.stop, "{} exposures from {} to {}", exposures.count,
          exposures.start, exposures.stop);
    FlipMap map{std::vector<float>(reference.pixelCount(), 0.0f), 0};
    Flip flip(reference.width, reference.height, pixels_per_degree);
    const float step = (exposures.stop - exposures.start) / float(exposures.count - 1);
    for (uint32_t i = 0; i < exposures.count; ++i)
    {
        const float scale = std::exp2(exposures.start + float(i) * step);
        flip.raise(
            reference, test, [scale](float v) { return acesCurve(std::max(v, 0.0f) * scale); }, map.error);
    }
    setMean(map);
    return map;
}
