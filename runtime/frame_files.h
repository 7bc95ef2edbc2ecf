// The files of a sequence: a name a frame, and which of them are there.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <filesystem>
#include <vector>

struct NumberRange
{
    uint32_t first = 0, last = 0; // both included
    uint32_t count() const { return last - first + 1; }
};

/// Numbers of frames, ascending.
struct FramesThere
{
    std::vector<uint32_t> whole, missing; // missing: not there, or not whole
};

class FrameFiles
{
public:
    /// @param pattern a file name with one %d or %0Nd (N digits at least, 1 to 9) for the frame's number
    /// @return kUsage naming what is wrong with it
    static Result<FrameFiles> parse(const std::filesystem::path& pattern);

    std::filesystem::path of(uint32_t frame) const;

    /// Looks on the disk which of `range` are there. @return kIo naming a file that is no frame of width x height pixels
    Result<FramesThere> look(NumberRange range, uint32_t width, uint32_t height) const;

private:
    std::filesystem::path folder_;
    std::string before_, after_; // the number, in the file's name
    size_t digits_ = 1;
};
