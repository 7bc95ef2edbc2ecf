#include "image/read_hdr.h"

#include "image/hdr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{
using Rgbe = std::array<uint8_t, 4>;

enum class Damage
{
    kNone,
    kCut,     // the file ends too early
    kOverrun, // a run goes beyond the end of its line
    kNoRun,   // a run of no pixels
    kNothing, // a run that repeats the pixel before the first
    kLength,  // a line states another length than the header
};

const char* describe(Damage damage)
{
    switch (damage)
    {
    case Damage::kCut:
        return "the file is cut off there";
    case Damage::kOverrun:
        return "a run goes beyond its end";
    case Damage::kNoRun:
        return "it has a run of no pixels";
    case Damage::kNothing:
        return "it begins with a repetition";
    case Damage::kLength:
        return "it states another length than the header";
    case Damage::kNone:
        break;
    }
    return "";
}

/// The bytes that follow the header, taken from the front.
class Bytes
{
public:
    explicit Bytes(std::span<const std::byte> bytes)
        : at_(reinterpret_cast<const uint8_t*>(bytes.data())), end_(at_ + bytes.size())
    {
    }
    size_t left() const { return size_t(end_ - at_); }
    const uint8_t* peek() const { return at_; }
    const uint8_t* take(size_t count)
    {
        const uint8_t* const taken = at_;
        at_ += count;
        return taken;
    }

private:
    const uint8_t* at_;
    const uint8_t* end_;
};

constexpr size_t kLeastNewRunLine = 8; // pixels: shorter and longer lines have no new run lengths
constexpr size_t kMostNewRunLine = 32767;

/// Each of the four components by itself, runs (128 + n, value) and n literal values.
Damage readNewRuns(Bytes& bytes, std::span<Rgbe> line)
{
    for (size_t component = 0; component < 4; ++component)
    {
        for (size_t i = 0; i < line.size();)
        {
            if (bytes.left() < 2)
                return Damage::kCut;
            const uint8_t code = *bytes.take(1);
            const size_t count = code > 128 ? code - 128u : code;
            if (count == 0)
                return Damage::kNoRun;
            if (count > line.size() - i)
                return Damage::kOverrun;
            const size_t stored = code > 128 ? 1 : count;
            if (bytes.left() < stored)
                return Damage::kCut;
            const uint8_t* values = bytes.take(stored);
            for (size_t k = 0; k < count; ++k)
                line[i++][component] = values[code > 128 ? 0 : k];
        }
    }
    return Damage::kNone;
}

/// Whole pixels; (1, 1, 1, n) repeats the one before n times, a further such one right after it 256 n times and so on.
/// A flat line is one without repetitions.
Damage readOldRuns(Bytes& bytes, std::span<Rgbe> line)
{
    int shift = 0;
    for (size_t i = 0; i < line.size();)
    {
        if (bytes.left() < 4)
            return Damage::kCut;
        const uint8_t* pixel = bytes.take(4);
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1)
        {
            line[i++] = {pixel[0], pixel[1], pixel[2], pixel[3]};
            shift = 0;
            continue;
        }
        if (i == 0)
            return Damage::kNothing;
        if (shift > 16 || size_t(pixel[3]) << shift > line.size() - i)
            return Damage::kOverrun;
        const size_t count = size_t(pixel[3]) << shift;
        std::fill_n(line.begin() + ptrdiff_t(i), count, line[i - 1]);
        i += count;
        shift += 8;
    }
    return Damage::kNone;
}

Damage readLine(Bytes& bytes, std::span<Rgbe> line)
{
    const uint8_t* front = bytes.peek();
    const bool new_runs = line.size() >= kLeastNewRunLine && line.size() <= kMostNewRunLine && bytes.left() >= 4 &&
                          front[0] == 2 && front[1] == 2 && front[2] < 128;
    if (!new_runs)
        return readOldRuns(bytes, line);
    if ((size_t(front[2]) << 8 | front[3]) != line.size())
        return Damage::kLength;
    bytes.take(4);
    return readNewRuns(bytes, line);
}

/// 2^(exponent - 136), by which a mantissa byte counts; writers round, so that no half is added. Exponent 0 is black.
std::array<float, 256> exponentScales()
{
    std::array<float, 256> scales{};
    for (int exponent = 1; exponent < 256; ++exponent)
        scales[size_t(exponent)] = std::ldexp(1.0f, exponent - 136);
    return scales;
}

void toRadiance(const HdrHeader& header, const std::array<float, 256>& scales, std::span<const Rgbe> line, float* rgb)
{
    constexpr double kMost = std::numeric_limits<float>::max();
    const bool plain = header.factor == std::array<double, 3>{1, 1, 1};
    for (size_t i = 0; i < line.size(); ++i, rgb += 3)
    {
        for (size_t c = 0; c < 3; ++c)
        {
            rgb[c] = float(line[i][c]) * scales[line[i][3]];
            if (!plain)
                rgb[c] = float(std::min(rgb[c] * header.factor[c], kMost));
        }
        if (header.to_rec709 != kIdentity3)
            transform(header.to_rec709, rgb);
    }
}

/// Where line `index` of a picture lies.
ScanLine placeLine(const HdrHeader& header, uint32_t index, std::span<const float> rgb)
{
    const bool from_end = header.columns ? header.right_to_left : header.bottom_up;
    const bool backwards = header.columns ? header.bottom_up : header.right_to_left;
    const uint32_t across = from_end ? header.line_count - 1 - index : index;
    const uint32_t first = backwards ? header.line_pixels - 1 : 0;
    const int step = backwards ? -1 : 1;
    return header.columns ? ScanLine{across, first, 0, step, rgb} : ScanLine{first, across, step, 0, rgb};
}
} // namespace

Status readHdr(std::span<const std::byte> file, PictureSink& sink)
{
    const Result<HdrHeader> header = parseHdrHeader(file);
    if (!header)
        return header.error();
    Bytes bytes(file.subspan(header->bytes));
    // The shortest line is one pixel, or one and a repetition of it.
    if (bytes.left() / (header->line_pixels > 1 ? 8 : 4) < header->line_count)
        return Error{ExitCode::kInvalid,
                     fmt::format("the HDR image is cut off: {} bytes cannot hold {} lines of {} pixels", bytes.left(),
                                 header->line_count, header->line_pixels)};

    const PictureInfo info{.width = header->columns ? header->line_count : header->line_pixels,
                           .height = header->columns ? header->line_pixels : header->line_count,
                           .notes = header->notes};
    if (const Status status = sink.begin(info); !status)
        return status;
    const std::array<float, 256> scales = exponentScales();
    std::vector<Rgbe> line(header->line_pixels);
    std::vector<float> rgb(3 * line.size());
    for (uint32_t i = 0; i < header->line_count; ++i)
    {
        if (const Damage damage = readLine(bytes, line); damage != Damage::kNone)
            return Error{ExitCode::kInvalid, fmt::format("the HDR image is damaged in line {} of {}: {}", i + 1,
                                                         header->line_count, describe(damage))};
        toRadiance(*header, scales, line, rgb.data());
        sink.add(placeLine(*header, i, rgb));
    }
    return Success{};
}
