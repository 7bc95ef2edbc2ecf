#include "runtime/frame_writer.h"

#include <thread>

bool FrameWriter::hasRoom(uint64_t bytes) const
{
    for (const Pending& pending : pending_)
        bytes += pending.bytes;
    return bytes <= kMostBytes && pending_.size() < std::max(std::thread::hardware_concurrency(), 1u);
}

Status FrameWriter::write(Capture frame)
{
    while (!pending_.empty() && !hasRoom(frame.byteCount()))
        if (const Status status = finishOldest(); !status)
            return status;
    pending_.push_back(
        {.path = frame.path(),
         .bytes = frame.byteCount(),
         .status = std::async(std::launch::async, [this, frame = std::move(frame)] { return frame.write(notes_); })});
    return Success{};
}

Status FrameWriter::finish()
{
    while (!pending_.empty())
        if (const Status status = finishOldest(); !status)
            return status;
    return Success{};
}

Status FrameWriter::finishOldest()
{
    Pending oldest = std::move(pending_.front());
    pending_.pop_front();
    if (const Status status = oldest.status.get(); !status)
        return status.error().about(oldest.path.string());
    fmt::print(stderr, "{} ({} of {})\n", oldest.path.string(), ++written_count_, frame_count_);
    return Success{};
}
