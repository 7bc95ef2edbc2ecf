// Writes the frames of a sequence while the next ones are rendered.
#pragma once
#include "runtime/capture.h"

#include <deque>
#include <future>

/// Encodes and writes frames on threads of their own, one for each core at most.
class FrameWriter
{
public:
    /// @param notes for every frame's header, @param frame_count that are to be written: the lines on stderr name it
    FrameWriter(std::vector<PictureNote> notes, size_t frame_count)
        : notes_(std::move(notes)), frame_count_(frame_count)
    {
    }

    /// Begins with one more frame; first waits for the oldest where as many are begun as there are cores, or they take
    /// too much memory.
    /// @return the error of an earlier frame that could not be written, which it names
    Status write(Capture frame);
    /// Waits for all of them. @return as of write()
    Status finish();
    size_t writtenCount() const { return written_count_; }

private:
    static constexpr uint64_t kMostBytes = 1 << 30; // of all pictures; one more than that is written alone

    struct Pending
    {
        std::filesystem::path path;
        uint64_t bytes;
        std::future<Status> status; // waits where it is destroyed
    };
    Status finishOldest();
    /// Whether there is room for a picture of so many bytes beside those that have begun.
    bool hasRoom(uint64_t bytes) const;

    std::vector<PictureNote> notes_;
    size_t frame_count_, written_count_ = 0;
    std::deque<Pending> pending_;
};
