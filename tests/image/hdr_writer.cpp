#include "tests/image/hdr_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace
{
using Rgbe = std::array<uint8_t, 4>;

Rgbe encode(const float* rgb)
{
    const float most = std::max({rgb[0], rgb[1], rgb[2]});
    if (most < 1e-32f)
        return {};
    int exponent = 0;
    std::frexp(most, &exponent);
    const auto mantissa = [&](float value) { return uint8_t(std::ldexp(value, 8 - exponent)); };
    return {mantissa(rgb[0]), mantissa(rgb[1]), mantissa(rgb[2]), uint8_t(exponent + 128)};
}

size_t runLength(const std::vector<Rgbe>& line, size_t from, size_t component)
{
    size_t n = 1;
    while (from + n < line.size() && n < 127 && line[from + n][component] == line[from][component])
        ++n;
    return n;
}

void appendNew(std::string& out, const std::vector<Rgbe>& line)
{
    out += {2, 2, char(line.size() >> 8), char(line.size())};
    for (size_t component = 0; component < 4; ++component)
        for (size_t i = 0; i < line.size();)
        {
            const size_t run = runLength(line, i, component);
            if (run > 2)
            {
                out += {char(128 + run), char(line[i][component])};
                i += run;
                continue;
            }
            size_t literal = 1;
            while (i + literal < line.size() && literal < 128 && runLength(line, i + literal, component) <= 2)
                ++literal;
            out += char(literal);
            for (size_t k = 0; k < literal; ++k)
                out += char(line[i + k][component]);
            i += literal;
        }
}

void appendOld(std::string& out, const std::vector<Rgbe>& line, bool runs)
{
    for (size_t i = 0; i < line.size();)
    {
        out.append(line[i].begin(), line[i].end());
        size_t repeats = 0;
        while (runs && i + 1 + repeats < line.size() && line[i + 1 + repeats] == line[i])
            ++repeats;
        for (size_t rest = repeats; rest > 0; rest >>= 8)
            out += {1, 1, 1, char(rest)};
        i += 1 + repeats;
    }
}
} // namespace

std::vector<std::byte> writeHdr(const ImageF& image, const HdrStyle& style)
{
    const std::string first = style.orientation.substr(0, 2), second = style.orientation.substr(3, 2);
    const bool columns = first[1] == 'X';
    const uint32_t line_count = columns ? image.width : image.height, pixels = columns ? image.height : image.width;
    // The first line is the top row and the leftmost column where its sign is - for Y and + for X.
    const auto isReversed = [](const std::string& axis) { return axis == "+Y" || axis == "-X"; };
    std::string out = style.magic + "\n" + style.lines + "\n" + first + " " + std::to_string(line_count) + " " +
                      second + " " + std::to_string(pixels) + "\n";
    for (uint32_t i = 0; i < line_count; ++i)
    {
        std::vector<Rgbe> line;
        for (uint32_t k = 0; k < pixels; ++k)
        {
            const uint32_t across = isReversed(first) ? line_count - 1 - i : i,
                           along = isReversed(second) ? pixels - 1 - k : k;
            const uint32_t x = columns ? across : along, y = columns ? along : across;
            line.push_back(encode(&image.rgb[3 * (size_t(y) * image.width + x)]));
        }
        if (style.runs == HdrRuns::kNew)
            appendNew(out, line);
        else
            appendOld(out, line, style.runs == HdrRuns::kOld);
    }
    const auto* bytes = reinterpret_cast<const std::byte*>(out.data());
    return {bytes, bytes + out.size()};
}

ImageF exactHdrImage(uint32_t width, uint32_t height, uint32_t seed)
{
    std::minstd_rand random(seed);
    ImageF image{width, height, {}};
    while (image.rgb.size() < 3 * image.pixelCount())
    {
        const float scale = std::ldexp(1.0f, int(random() % 24) - 12);
        const std::array<float, 3> rgb{scale * float(128 + random() % 128), scale * float(random() % 128),
                                       scale * float(random() % 128)};
        const size_t run = random() % 3 == 0 ? 1 + random() % 400 : 1;
        for (size_t i = 0; i < run && image.rgb.size() < 3 * image.pixelCount(); ++i)
            image.rgb.insert(image.rgb.end(), rgb.begin(), rgb.end());
    }
    return image;
}
