#include "runtime/frame_files.h"

#include "image/picture_file.h"

#include <fmt/format.h>

Result<FrameFiles> FrameFiles::parse(const std::filesystem::path& pattern)
{
    const std::string name = pattern.filename().string();
    const auto refuse = [&](const char* what)
    {
        return Error{
            ExitCode::kUsage,
            fmt::format(
                "--output {}: {}; the name of a frame has one %d or %0Nd for its number, such as frame-%04d.exr",
                pattern.string(), what)};
    };
    const size_t begin = name.find('%');
    if (begin == std::string::npos)
        return refuse("there is no place for the number");
    if (name.find('%', begin + 1) != std::string::npos)
        return refuse("there is more than one %");
    size_t end = begin + 1;
    FrameFiles files;
    if (name.substr(end, 1) == "0" && end + 1 < name.size() && name[end + 1] >= '1' && name[end + 1] <= '9')
    {
        files.digits_ = size_t(name[end + 1] - '0');
        end += 2;
    }
    if (name.substr(end, 1) != "d")
        return refuse("what stands for the number cannot be read");
    if (pattern.parent_path().string().find('%') != std::string::npos)
        return refuse("the number belongs in the file's name, not in that of its folder");
    files.folder_ = pattern.parent_path();
    files.before_ = name.substr(0, begin);
    files.after_ = name.substr(end + 1);
    return files;
}

std::filesystem::path FrameFiles::of(uint32_t frame) const
{
    return folder_ / fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

Result<FramesThere> FrameFiles::look(NumberRange range, uint32_t width, uint32_t height) const
{
    FramesThere frames;
    for (uint32_t i = 0; i < range.count(); ++i)
    {
        const uint32_t frame = range.first + i;
        const PictureState state = pictureState(of(frame), width, height);
        if (state == PictureState::kOther)
            return Error{
                ExitCode::kIo,
                fmt::format(
                    "is there already and is no frame of {}x{} pixels; move it away, or give --force to replace it",
                    width, height),
                of(frame).string()};
        (state == PictureState::kWhole ? frames.whole : frames.missing).push_back(frame);
    }
    return frames;
}
