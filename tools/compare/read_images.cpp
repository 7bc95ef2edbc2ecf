#include "tools/compare/read_images.h"

#include "image/read_exr.h"

#include <fmt/format.h>

namespace
{

Result<ImageF> cropped(const ImageF& image, const std::vector<uint32_t>& crop)
{
    if (crop.empty())
        return image;
    if (crop[0] >= crop[2] || crop[1] >= crop[3] || crop[2] > image.width || crop[3] > image.height)
        return Error{ExitCode::kUsage,
                     fmt::format("--crop {},{},{},{} does not lie in the image of {} x {} pixels; give "
                                 "the left, top, right and bottom edge, the last two exclusive.",
                                 crop[0], crop[1], crop[2], crop[3], image.width, image.height)};
    ImageF part{crop[2] - crop[0], crop[3] - crop[1], {}};
    for (uint32_t y = crop[1]; y < crop[3]; ++y)
    {
        const auto row = image.rgb.begin() + std::ptrdiff_t(3 * (size_t(y) * image.width + crop[0]));
        part.rgb.insert(part.rgb.end(), row, row + std::ptrdiff_t(3 * size_t(part.width)));
    }
    return part;
}

} // namespace

int fail(const std::string& file, const Error& error)
{
    fmt::print(stderr, "{}: error: {}\n", file, error.message);
    return int(error.code);
}

std::optional<int> readImages(const std::vector<std::string>& files, const std::vector<uint32_t>& crop,
                              const std::string& first_name, std::vector<ImageF>& images)
{
    uint32_t width = 0, height = 0;
    for (const std::string& file : files)
    {
        const Result<ImageF> image = readExr(file);
        if (!image)
            return fail(file, image.error());
        if (images.empty())
            width = image->width, height = image->height;
        if (image->width != width || image->height != height)
            return fail(file, {ExitCode::kInvalid,
                               fmt::format("The image has {} x {} pixels but the {} {} has {} x {}; render both "
                                           "in the same size.",
                                           image->width, image->height, first_name, files[0], width, height)});
        Result<ImageF> part = cropped(*image, crop);
        if (!part)
            return fail(file, part.error());
        images.push_back(std::move(*part));
    }
    return std::nullopt;
}
