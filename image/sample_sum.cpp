#include "image/sample_sum.h"

#include "format/mapped_file.h"
#include "image/exr_headers.h"
#include "image/exr_stream.h"
#include "image/write_image.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace
{
constexpr int kUnitBits = 64; // a unit is 2^-kUnitBits

double inRadiance(Int128 sum)
{
    return std::ldexp(double(sum), -kUnitBits);
}

/// Of a float whose last bit is worth a unit or more, or that is 0.
Int128 inUnits(float value)
{
    int exponent = 0;
    const float fraction = std::frexp(value, &exponent);
    constexpr int kMantissaBits = 24;
    const auto mantissa = int32_t(std::ldexp(fraction, kMantissaBits));
    const int shift = exponent - kMantissaBits + kUnitBits;
    return shift >= 0 ? Int128(mantissa) * (Int128(1) << shift) : Int128(mantissa) / (Int128(1) << -shift);
}

Error invalid(std::string sentence)
{
    return {ExitCode::kInvalid, std::move(sentence)};
}

std::optional<std::vector<SampleRange>> parseSamples(std::string_view text)
{
    std::vector<SampleRange> samples;
    const char* at = text.data();
    const char* const end = at + text.size();
    const auto number = [&](uint32_t& value)
    {
        const auto [stop, error] = std::from_chars(at, end, value);
        at = stop;
        return error == std::errc();
    };
    for (;;)
    {
        SampleRange range;
        if (!number(range.first) || at == end || *at++ != '-' || !number(range.last) || range.last < range.first ||
            (!samples.empty() && range.first <= samples.back().last))
            return std::nullopt;
        samples.push_back(range);
        if (at == end)
            return samples;
        if (*at++ != ',')
            return std::nullopt;
    }
}

std::string layerName(size_t layer)
{
    return fmt::format("sum{}", layer);
}

Status readSums(std::span<const std::byte> bytes, SampleSum& sum)
{
    ExrStream stream(bytes);
    Imf::InputFile file(stream);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    if (window.min != Imath::V2i(0, 0) || header.hasTileDescription() || !file.isComplete())
        return invalid("is cut off, or was not written by lumicut");
    std::vector<float> plane(size_t(sum.width) * sum.height);
    sum.sums.assign(3 * plane.size(), 0);
    for (size_t layer = 0; layer == 0 || header.channels().findChannel(layerName(layer) + ".R"); ++layer)
        for (size_t c = 0; c < 3; ++c)
        {
            const std::string name = layerName(layer) + "." + "RGB"[c];
            const Imf::Channel* channel = header.channels().findChannel(name);
            if (!channel || channel->type != Imf::FLOAT || channel->xSampling != 1 || channel->ySampling != 1)
                return invalid(fmt::format("has no channel {} of 32-bit floats: give pictures of --samples", name));
            Imf::FrameBuffer target;
            target.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(plane.data()), sizeof(float),
                                           sizeof(float) * sum.width));
            file.setFrameBuffer(target);
            file.readPixels(0, int(sum.height) - 1);
            for (size_t pixel = 0; pixel < plane.size(); ++pixel)
            {
                if (!(std::abs(plane[pixel]) < 0x1p62f)) // nor NaN: no sum of ours
                    return invalid(fmt::format("its channel {} holds what is no sum of samples", name));
                sum.sums[3 * pixel + c] += inUnits(plane[pixel]);
            }
        }
    return Success{};
}
} // namespace

uint64_t SampleSum::sampleCount() const
{
    uint64_t count = 0;
    for (const SampleRange& range : samples)
        count += uint64_t(range.last) - range.first + 1;
    return count;
}

std::string samplesText(std::span<const SampleRange> samples)
{
    std::string text;
    for (const SampleRange& range : samples)
        text += fmt::format("{}{}-{}", text.empty() ? "" : ",", range.first, range.last);
    return text;
}

Status writeSampleSum(const std::filesystem::path& path, const SampleSum& sum)
{
    std::vector<std::vector<float>> values(1);
    for (const Int128 total : sum.sums)
        values[0].push_back(float(inRadiance(total) / double(sum.sampleCount())));
    std::vector<Int128> left = sum.sums;
    while (values.size() == 1 || std::ranges::any_of(left, [](Int128 rest) { return rest != 0; }))
    {
        std::vector<float>& layer = values.emplace_back();
        for (Int128& rest : left)
        {
            layer.push_back(float(inRadiance(rest)));
            rest -= inUnits(layer.back());
        }
    }
    std::vector<ExrLayer> layers;
    for (size_t i = 0; i < values.size(); ++i)
        layers.push_back({.name = i == 0 ? "" : layerName(i - 1), .channels = "RGB", .values = values[i]});
    PictureOrigin origin = sum.origin;
    origin.samples = samplesText(sum.samples);
    return writeExr(path, sum.width, sum.height, layers, originNotes(origin));
}

Result<SampleSum> readSampleSum(const std::filesystem::path& path)
{
    const auto file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    try
    {
        const auto headers = readExrHeaders(file->bytes());
        if (!headers)
            return headers.error();
        const ExrWindow window(headers->front().dataWindow());
        SampleSum sum{.width = uint32_t(window.width()),
                      .height = uint32_t(window.height()),
                      .sums = {},
                      .samples = {},
                      .origin = {}};
        auto origin = readOrigin(path);
        if (!origin)
            return origin.error();
        const auto samples = parseSamples(origin->samples);
        if (headers->size() != 1 || !samples)
            return invalid("does not say which samples it is the sum of: give pictures of --samples");
        sum.origin = std::move(*origin);
        sum.samples = *samples;
        if (const Status status = readSums(file->bytes(), sum); !status)
            return status.error();
        return sum;
    }
    catch (const std::exception& problem) // of the library
    {
        const std::string reason = problem.what();
        return invalid(fmt::format("is damaged or incomplete: {}", reason.substr(0, reason.find('\n'))));
    }
}

Status addSamples(SampleSum& sum, const SampleSum& part)
{
    if (part.width != sum.width || part.height != sum.height)
        return invalid(
            fmt::format("has {}x{} pixels, the first part {}x{}", part.width, part.height, sum.width, sum.height));
    if (const std::string differing = difference(part.origin, sum.origin); !differing.empty())
        return invalid(fmt::format("was rendered {}: it is no part of the same picture", differing));
    std::vector<SampleRange> all = sum.samples;
    all.insert(all.end(), part.samples.begin(), part.samples.end());
    std::ranges::sort(all, {}, &SampleRange::first);
    std::vector<SampleRange> joined;
    for (const SampleRange& range : all)
    {
        if (!joined.empty() && range.first <= joined.back().last)
            return invalid(fmt::format("holds sample {}, which another part holds, too", range.first));
        if (!joined.empty() && range.first == joined.back().last + 1)
            joined.back().last = range.last;
        else
            joined.push_back(range);
    }
    sum.samples = std::move(joined);
    for (size_t i = 0; i < sum.sums.size(); ++i)
        sum.sums[i] += part.sums[i];
    if (sum.origin.device.find(part.origin.device) == std::string::npos)
        sum.origin.device =
            std::min(sum.origin.device + ", " + part.origin.device, part.origin.device + ", " + sum.origin.device);
    return Success{};
}
