#include "runtime/path_recorder.h"

namespace
{
// Far enough apart for curves between keys to smooth the steps of a mouse, near enough to follow the hand.
constexpr double kBetweenKeys = 0.2; // seconds
} // namespace

void PathRecorder::add(const Camera& camera, double seconds)
{
    now_ += seconds;
    if (now_ - keys_.back().time >= kBetweenKeys)
        keys_.push_back({now_, camera});
}

CameraPath PathRecorder::finish(const Camera& camera)
{
    if (now_ - keys_.back().time >= CameraPath::kLeastStep)
        keys_.push_back({now_, camera});
    return CameraPath(keys_);
}
