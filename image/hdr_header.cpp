#include "image/hdr_header.h"

#include "image/picture.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace
{
Error invalid(std::string message)
{
    return {ExitCode::kInvalid, std::move(message)};
}

/// The next line of `text` without its end, which `text` loses. Nothing where no line ends any more.
std::optional<std::string_view> takeLine(std::string_view& text)
{
    const size_t end = text.find('\n');
    if (end == std::string_view::npos)
        return std::nullopt;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (line.ends_with('\r'))
        line.remove_suffix(1);
    return line;
}

std::string_view takeWord(std::string_view& text)
{
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    const std::string_view word = text.substr(0, text.find_first_of(" \t"));
    text.remove_prefix(word.size());
    return word;
}

/// @return whether `text` holds exactly `values.size()` finite numbers
bool parseNumbers(std::string_view text, std::span<double> values)
{
    for (double& value : values)
    {
        std::string_view word = takeWord(text);
        if (word.starts_with('+'))
            word.remove_prefix(1);
        const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (failure != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
            return false;
    }
    return takeWord(text).empty();
}

/// Divides `factor` by the numbers of an EXPOSURE or COLORCORR line.
bool divide(std::array<double, 3>& factor, std::string_view text, size_t count)
{
    std::array<double, 3> numbers{};
    if (!parseNumbers(text, std::span(numbers).first(count)))
        return false;
    for (size_t i = 0; i < 3; ++i)
    {
        factor[i] /= numbers[i % count];
        if (!(numbers[i % count] > 0) || !(factor[i] > 0) || !std::isfinite(factor[i]))
            return false;
    }
    return true;
}

/// Some writers fill the line with zeros if the values are unknown.
bool isUnstated(const Primaries& p)
{
    constexpr std::array<double, 2> kZero{};
    return p.red == kZero && p.green == kZero && p.blue == kZero && p.white == kZero;
}

Status applyVariable(std::string_view line, HdrHeader& header, Primaries& primaries)
{
    const size_t equals = line.find('=');
    if (equals == std::string_view::npos)
        return Success{}; // a comment or a command
    const std::string_view name = line.substr(0, equals);
    std::string_view value = line.substr(equals + 1);
    const auto unclear = [&]
    { return invalid(fmt::format("the HDR image has the line \"{}\", which makes no sense", line.substr(0, 80))); };
    if (name == "FORMAT")
    {
        const std::string_view format = takeWord(value);
        if (format == "32-bit_rle_xyze")
            primaries = kXyzPrimaries;
        else if (format != "32-bit_rle_rgbe")
            return Error{
                ExitCode::kUnsupported,
                fmt::format("the HDR image has the format \"{}\"; save it as 32-bit_rle_rgbe", format.substr(0, 80))};
    }
    else if (name == "EXPOSURE" && !divide(header.factor, value, 1))
        return unclear();
    else if (name == "COLORCORR" && !divide(header.factor, value, 3))
        return unclear();
    else if (name == "PRIMARIES")
    {
        std::array<double, 8> n{};
        if (!parseNumbers(value, n))
            return unclear();
        primaries = {{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
    }
    return Success{};
}

/// "-Y 512 +X 1024": lines from the top, pixels from the left. The axis named first is that from line to line.
Status applyResolution(std::string_view line, HdrHeader& header)
{
    const auto unclear = [&]
    {
        return invalid(fmt::format("the HDR image has \"{}\" where its size should be, such as -Y 512 +X 1024",
                                   line.substr(0, 80)));
    };
    std::string_view rest = line;
    std::string axes;
    std::array<uint32_t*, 2> counts{&header.line_count, &header.line_pixels};
    for (uint32_t* count : counts)
    {
        const std::string_view axis = takeWord(rest);
        const std::string_view number = takeWord(rest);
        int64_t value = 0;
        const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), value);
        if (axis.size() != 2 || (axis[0] != '+' && axis[0] != '-') || failure == std::errc::invalid_argument ||
            end != number.data() + number.size())
            return unclear();
        if (failure != std::errc() || value < 1 || value > kMaxPictureSide)
            return Error{failure == std::errc() && value < 1 ? ExitCode::kInvalid : ExitCode::kUnsupported,
                         fmt::format("the HDR image has a side of {} pixels, allowed are 1 to {}", number.substr(0, 40),
                                     kMaxPictureSide)};
        *count = uint32_t(value);
        axes += axis[1];
        if (axis[1] == 'Y')
            header.bottom_up = axis[0] == '+';
        else
            header.right_to_left = axis[0] == '-';
    }
    if ((axes != "YX" && axes != "XY") || !takeWord(rest).empty())
        return unclear();
    header.columns = axes == "XY";
    if (int64_t(header.line_count) * header.line_pixels > kMaxPicturePixels)
        return Error{
            ExitCode::kUnsupported,
            fmt::format("the HDR image has {} lines of {} pixels, more than the {} pixels that are read; reduce it",
                        header.line_count, header.line_pixels, kMaxPicturePixels)};
    return Success{};
}
} // namespace

Result<HdrHeader> parseHdrHeader(std::span<const std::byte> file)
{
    const std::string_view whole(reinterpret_cast<const char*>(file.data()), file.size());
    std::string_view text = whole;
    if (!text.starts_with("#?"))
        return invalid("the file is no Radiance HDR image: it does not begin with #?RADIANCE");
    HdrHeader header;
    Primaries primaries;
    while (true)
    {
        const std::optional<std::string_view> line = takeLine(text);
        if (!line)
            return invalid("the HDR image is cut off within its header");
        if (line->empty())
            break;
        if (const Status status = applyVariable(*line, header, primaries); !status)
            return status.error();
    }
    const std::optional<std::string_view> resolution = takeLine(text);
    if (!resolution)
        return invalid("the HDR image is cut off within its header");
    if (const Status status = applyResolution(*resolution, header); !status)
        return status.error();
    const std::optional<Matrix3> to_rec709 = toRec709(primaries);
    if (to_rec709)
        header.to_rec709 = *to_rec709;
    else if (!isUnstated(primaries))
        header.notes.push_back("the HDR image has PRIMARIES that span no colours: it is taken for Rec. 709");
    header.bytes = whole.size() - text.size();
    return header;
}
