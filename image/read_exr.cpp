#include "image/read_exr.h"

#include "format/mapped_file.h"
#include "image/exr_channels.h"
#include "image/exr_headers.h"
#include "image/exr_stream.h"
#include "image/primaries.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <new>

namespace
{
Error invalid(std::string message)
{
    return {ExitCode::kInvalid, std::move(message)};
}

/// Whether it is a cube map by its attribute; kUnsupported for other kinds than those and equirectangular maps.
Result<bool> isCube(const Imf::Header& header)
{
    if (header.find("envmap") == header.end())
        return false;
    if (Imf::hasEnvmap(header) &&
        (Imf::envmap(header) == Imf::ENVMAP_LATLONG || Imf::envmap(header) == Imf::ENVMAP_CUBE))
        return Imf::envmap(header) == Imf::ENVMAP_CUBE;
    return Error{ExitCode::kUnsupported,
                 "the EXR image's attribute \"envmap\" names neither a latitude-longitude map nor a "
                 "cube; convert it to one of them"};
}

Primaries primariesOf(const Imf::Header& header, std::vector<std::string>& notes)
{
    if (!Imf::hasChromaticities(header))
        return Primaries{};
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    const Primaries primaries{{c.red.x, c.red.y}, {c.green.x, c.green.y}, {c.blue.x, c.blue.y}, {c.white.x, c.white.y}};
    if (toRec709(primaries))
        return primaries;
    notes.push_back("the EXR image has chromaticities that span no colours: it is taken for Rec. 709");
    return {};
}

/// Reads the chosen channels of one part and passes on what lies in its window.
class PartReader
{
public:
    PartReader(Imf::MultiPartInputFile& file, const ExrChannels& chosen, const Primaries& primaries,
               const ExrWindow& shown)
        : part_(file, chosen.part), chosen_(chosen), data_(part_.header().dataWindow()), shown_(shown),
          to_rec709_(*toRec709(primaries)), to_xyz_(*toXyz(primaries))
    {
    }

    void read(PictureSink& sink)
    {
        const int64_t from = std::max(data_.min_y, shown_.min_y), to = std::min(data_.max_y, shown_.max_y);
        if (from >= to || std::max(data_.min_x, shown_.min_x) >= std::min(data_.max_x, shown_.max_x))
            return; // outside the display window
        const bool whole = std::ranges::any_of(chosen_.names, [&](const auto& name) { return isSubsampled(name); });
        // Strips begin where blocks do, so that none is decoded twice.
        const int64_t rows = whole ? data_.height() : std::min(exrStripRows(part_.header()), data_.height());
        const int64_t first = data_.min_y + (from - data_.min_y) / rows * rows;
        for (int64_t y = first; y < to; y += rows)
        {
            const int64_t end = std::min(y + rows, data_.max_y);
            readStrip(y, end);
            for (int64_t row = std::max(y, from); row < std::min(end, to); ++row)
                pass(row, row - y, sink);
        }
    }

private:
    bool isSubsampled(const std::string& name) const
    {
        const Imf::Channel& channel = *part_.header().channels().findChannel(name);
        return channel.xSampling != 1 || channel.ySampling != 1;
    }

    /// Rows y <= row < end of the data window into rgb_, three floats a pixel.
    void readStrip(int64_t y, int64_t end)
    {
        rgb_.assign(size_t(3 * data_.width() * (end - y)), 0.0f);
        std::vector<std::vector<float>> planes(chosen_.names.size()); // of sub-sampled channels
        Imf::FrameBuffer frame;
        for (size_t i = 0; i < chosen_.names.size(); ++i)
        {
            const Imf::Channel& channel = *part_.header().channels().findChannel(chosen_.names[i]);
            if (!isSubsampled(chosen_.names[i]))
            {
                frame.insert(chosen_.names[i], slice(rgb_.data() + i, 3, data_.width(), data_.min_x, y, 1, 1));
                continue;
            }
            // The windows of a valid file are multiples of the sampling (the library refuses others).
            const int64_t columns = (data_.width() + channel.xSampling - 1) / channel.xSampling;
            const int64_t rows = (data_.height() + channel.ySampling - 1) / channel.ySampling;
            planes[i].assign(size_t(columns * rows), 0.0f);
            frame.insert(chosen_.names[i],
                         slice(planes[i].data(), 1, columns, data_.min_x / channel.xSampling,
                               data_.min_y / channel.ySampling, channel.xSampling, channel.ySampling));
        }
        part_.setFrameBuffer(frame);
        part_.readPixels(int(y), int(end - 1));
        for (size_t i = 0; i < planes.size(); ++i)
            if (!planes[i].empty())
                interpolate(planes[i], *part_.header().channels().findChannel(chosen_.names[i]), i);
    }

    /// The library addresses pixel (x, y) at base + x * x_stride + y * y_stride, from the origin of all coordinates.
    static Imf::Slice slice(float* first, int64_t pixel_floats, int64_t row_pixels, int64_t x, int64_t y,
                            int x_sampling, int y_sampling)
    {
        const auto x_stride = pixel_floats * int64_t(sizeof(float));
        const int64_t y_stride = x_stride * row_pixels;
        const auto base = std::bit_cast<uintptr_t>(first) - uintptr_t(x * x_stride + y * y_stride);
        return {Imf::FLOAT, std::bit_cast<char*>(base), size_t(x_stride), size_t(y_stride), x_sampling, y_sampling};
    }

    /// Bilinear between the samples, which lie at multiples of the sampling.
    void interpolate(const std::vector<float>& plane, const Imf::Channel& channel, size_t component)
    {
        const int64_t columns = (data_.width() + channel.xSampling - 1) / channel.xSampling;
        const int64_t rows = (data_.height() + channel.ySampling - 1) / channel.ySampling;
        for (int64_t y = 0; y < data_.height(); ++y)
        {
            const int64_t top = y / channel.ySampling, low = std::min(top + 1, rows - 1);
            const float down = float(y % channel.ySampling) / float(channel.ySampling);
            for (int64_t x = 0; x < data_.width(); ++x)
            {
                const int64_t left = x / channel.xSampling, right = std::min(left + 1, columns - 1);
                const float across = float(x % channel.xSampling) / float(channel.xSampling);
                const auto between = [&](int64_t row)
                {
                    const float a = plane[size_t(row * columns + left)], b = plane[size_t(row * columns + right)];
                    return across == 0 ? a : a * (1 - across) + b * across;
                };
                rgb_[size_t(3 * (y * data_.width() + x)) + component] =
                    down == 0 ? between(top) : between(top) * (1 - down) + between(low) * down;
            }
        }
    }

    /// Row `row`, which is row `in_strip` of rgb_, as far as it is shown.
    void pass(int64_t row, int64_t in_strip, PictureSink& sink)
    {
        const int64_t from = std::max(data_.min_x, shown_.min_x), to = std::min(data_.max_x, shown_.max_x);
        const std::span<float> rgb = std::span(rgb_).subspan(
            size_t(3 * (in_strip * data_.width() + from - data_.min_x)), size_t(3 * (to - from)));
        for (size_t i = 0; i < rgb.size(); i += 3)
            toRgb(&rgb[i]);
        sink.add({.x = uint32_t(from - shown_.min_x), .y = uint32_t(row - shown_.min_y), .rgb = rgb});
    }

    void toRgb(float* rgb) const
    {
        if (chosen_.colour == ExrColour::kGrey) // has no hue to convert
        {
            rgb[1] = rgb[2] = rgb[0];
            return;
        }
        if (chosen_.colour == ExrColour::kLuminanceChroma)
        {
            const double luminance = rgb[0], red = (rgb[1] + 1.0) * luminance, blue = (rgb[2] + 1.0) * luminance;
            const double green = (luminance - to_xyz_[3] * red - to_xyz_[5] * blue) / to_xyz_[4];
            rgb[0] = float(red), rgb[1] = float(green), rgb[2] = float(blue);
        }
        if (to_rec709_ != kIdentity3)
            transform(to_rec709_, rgb);
    }

    Imf::InputPart part_;
    const ExrChannels& chosen_;
    ExrWindow data_, shown_;
    Matrix3 to_rec709_, to_xyz_;
    std::vector<float> rgb_; // of the strip
};

Status readPicture(std::span<const std::byte> bytes, PictureSink& sink)
{
    const Result<std::vector<Imf::Header>> headers = readExrHeaders(bytes);
    if (!headers)
        return headers.error();
    ExrStream stream(bytes);
    Imf::MultiPartInputFile file(stream, 0, false);
    const Result<ExrChannels> chosen = chooseExrChannels(file);
    if (!chosen)
        return chosen.error();
    const Imf::Header& header = file.header(chosen->part);
    const Result<bool> cube = isCube(header);
    if (!cube)
        return cube.error();
    std::vector<std::string> notes = chosen->notes;
    const Primaries primaries = primariesOf(header, notes);
    const ExrWindow data(header.dataWindow());
    const ExrWindow shown = *cube ? data : ExrWindow(header.displayWindow());
    if (const Status status = checkExrWindow(shown, "display"); !status)
        return status;
    if (*cube && data.height() != 6 * data.width())
        return invalid(
            fmt::format("the EXR image is a cube map of {} x {} pixels; six square faces below each other are needed",
                        data.width(), data.height()));
    if (!file.partComplete(chosen->part))
        return invalid("the EXR image is cut off or damaged: blocks of it are missing");

    const PictureInfo info{uint32_t(shown.width()), uint32_t(shown.height()), *cube, std::move(notes)};
    if (const Status status = sink.begin(info); !status)
        return status;
    PartReader(file, *chosen, primaries, shown).read(sink);
    return Success{};
}

class ImageSink : public PictureSink
{
public:
    ImageF image;

    Status begin(const PictureInfo& info) override
    {
        constexpr uint64_t kMaxPixels = uint64_t(1) << 28;
        if (uint64_t(info.width) * info.height > kMaxPixels)
            return Error{ExitCode::kUnsupported, fmt::format("the EXR image has {} x {} pixels, at most {} are read",
                                                             info.width, info.height, kMaxPixels)};
        image = {info.width, info.height, std::vector<float>(3 * size_t(info.width) * info.height)};
        return Success{};
    }
    void add(const ScanLine& line) override
    {
        forEachPixel(line, [&](uint32_t x, uint32_t y, const float* rgb)
                     { std::copy_n(rgb, 3, &image.rgb[3 * (size_t(y) * image.width + x)]); });
    }
};
} // namespace

Status readExr(std::span<const std::byte> file, PictureSink& sink)
{
    try
    {
        return readPicture(file, sink);
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "there is not enough memory to read the EXR image"};
    }
    catch (const std::exception& problem)
    {
        const std::string reason = problem.what();
        return invalid(fmt::format("the EXR image is damaged or incomplete: {}", reason.substr(0, reason.find('\n'))));
    }
}

Result<ImageF> readExr(const std::filesystem::path& path)
{
    const Result<package::MappedFile> file = package::MappedFile::open(path);
    if (!file)
        return file.error();
    ImageSink sink;
    if (const Status status = readExr(file->bytes(), sink); !status)
        return status.error();
    return std::move(sink.image);
}
