#include "compiler/mip_chain.h"

#include <algorithm>
#include <cmath>

namespace
{
double srgbToLinear(double s)
{
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
double linearToSrgb(double l)
{
    return l <= 0.0031308 ? l * 12.92 : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

constexpr uint32_t kSteps = 65535; // of the tables of 16 bits

struct SrgbTables
{
    std::vector<float> linear_of_byte, linear_of_word; // [256], [65536]: 0 to 1
    std::vector<float> byte_of_linear;                 // [65536]: 0 to 255, whole numbers

    SrgbTables() : linear_of_byte(256), linear_of_word(kSteps + 1), byte_of_linear(kSteps + 1)
    {
        for (uint32_t i = 0; i < 256; ++i)
            linear_of_byte[i] = float(srgbToLinear(i / 255.0));
        for (uint32_t i = 0; i <= kSteps; ++i)
        {
            linear_of_word[i] = float(srgbToLinear(double(i) / kSteps));
            byte_of_linear[i] = float(std::round(linearToSrgb(double(i) / kSteps) * 255));
        }
    }
};

const SrgbTables& srgbTables()
{
    static const SrgbTables tables;
    return tables;
}

uint32_t half(uint32_t side)
{
    return std::max(side / 2, 1u);
}

} // namespace

void normalizeTexel(std::array<float, 4>& texel)
{
    std::array<float, 3> n;
    float squared = 0;
    for (size_t k = 0; k < 3; ++k)
    {
        n[k] = texel[k] / 127.5f - 1;
        squared += n[k] * n[k];
    }
    if (squared < 1e-6f)
        n = {0, 0, 1}, squared = 1;
    for (size_t k = 0; k < 3; ++k)
        texel[k] = std::clamp((n[k] / std::sqrt(squared) + 1) * 127.5f, 0.0f, 255.0f);
}

std::array<float, 4> MipChain::linear(uint32_t x, uint32_t y) const
{
    const size_t at = 4 * (size_t(y) * image_.width + x);
    const SrgbTables& tables = srgbTables();
    std::array<float, 4> out;
    if (!image_.deep.empty())
    {
        const uint16_t* t = image_.deep.data() + at;
        for (size_t k = 0; k < 4; ++k)
            out[k] = image_.srgb && k < 3 ? tables.linear_of_word[t[k]] : float(t[k]) / 65535;
        return out;
    }
    const uint8_t* t = image_.texels.data() + at;
    for (size_t k = 0; k < 4; ++k)
        out[k] = image_.srgb && k < 3 ? tables.linear_of_byte[t[k]] : float(t[k]) / 255;
    return out;
}

template <typename Texel>
MipChain::Level MipChain::halved(uint32_t width, uint32_t height, const Texel& at) const
{
    Level out{half(width), half(height), 1, {}};
    out.rgba.resize(size_t(4) * out.width * out.height);
    float* to = out.rgba.data();
    const uint32_t right = width > 1 ? 1 : 0, down = height > 1 ? 1 : 0;
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x, to += 4)
        {
            const std::array<std::array<float, 4>, 4> from{
                at(2 * x * right, 2 * y * down), at(2 * x * right + right, 2 * y * down),
                at(2 * x * right, 2 * y * down + down), at(2 * x * right + right, 2 * y * down + down)};
            for (size_t k = 0; k < 4; ++k)
                to[k] = 0.25f * (from[0][k] + from[1][k] + from[2][k] + from[3][k]);
            if (!role_.covers || to[3] == 0)
                continue;
            for (size_t k = 0; k < 3; ++k)
                to[k] = (from[0][k] * from[0][3] + from[1][k] * from[1][3] + from[2][k] * from[2][3] +
                         from[3][k] * from[3][3]) /
                        (4 * to[3]);
        }
    return out;
}

MipChain::MipChain(const TextureImage& image, const TextureRole& role) : image_(image), role_(role)
{
    if (image.width == 1 && image.height == 1)
        return;
    levels_.push_back(halved(image.width, image.height, [this](uint32_t x, uint32_t y) { return linear(x, y); }));
    while (levels_.back().width > 1 || levels_.back().height > 1)
    {
        const Level& last = levels_.back();
        levels_.push_back(halved(last.width, last.height,
                                 [&last](uint32_t x, uint32_t y)
                                 {
                                     const float* t = last.rgba.data() + 4 * (size_t(y) * last.width + x);
                                     return std::array<float, 4>{t[0], t[1], t[2], t[3]};
                                 }));
    }
    if (role_.coverage_cutoff > 0 && role_.coverage_cutoff <= 1)
        keepCoverage();
}

void MipChain::keepCoverage()
{
    size_t passing = 0;
    const size_t count = size_t(image_.width) * image_.height;
    for (size_t i = 0; i < count; ++i)
        passing += float(image_.texels[4 * i + 3]) >= role_.coverage_cutoff * 255 ? 1 : 0;
    for (Level& level : levels_)
    {
        std::vector<float> alphas(level.rgba.size() / 4);
        for (size_t i = 0; i < alphas.size(); ++i)
            alphas[i] = level.rgba[4 * i + 3];
        const size_t wanted = (passing * alphas.size() + count / 2) / count;
        if (wanted == 0 || wanted == alphas.size())
            continue; // all or nothing passes: averages preserve that except at the border
        std::nth_element(alphas.begin(), alphas.begin() + ptrdiff_t(wanted - 1), alphas.end(), std::greater<>());
        const float last_passing = alphas[wanted - 1];
        if (last_passing > 0) // a little more than the cutoff, so that rounding to 8 bits does not fall below it
            level.alpha_scale = (role_.coverage_cutoff + 0.5f / 255) / last_passing;
    }
}

std::array<float, 4> MipChain::texel(uint32_t level, uint32_t x, uint32_t y) const
{
    std::array<float, 4> out;
    if (level == 0)
    {
        const size_t at = 4 * (size_t(y) * image_.width + x);
        for (size_t k = 0; k < 4; ++k)
            out[k] = image_.deep.empty() ? float(image_.texels[at + k]) : float(image_.deep[at + k]) / 257;
        return out;
    }
    const Level& l = levels_[level - 1];
    const float* t = l.rgba.data() + 4 * (size_t(y) * l.width + x);
    const SrgbTables& tables = srgbTables();
    for (size_t k = 0; k < 3; ++k)
        out[k] = image_.srgb ? tables.byte_of_linear[size_t(t[k] * float(kSteps) + 0.5f)] : t[k] * 255;
    out[3] = std::min(t[3] * l.alpha_scale, 1.0f) * 255;
    if (role_.normal)
        normalizeTexel(out);
    return out;
}
