// A camera path from a camera that is flown by hand.
#pragma once
#include "runtime/camera_path.h"

class PathRecorder
{
public:
    explicit PathRecorder(const Camera& start) : keys_{{0, start}} {}

    /// `camera` is what a frame shows, `seconds` after the one before.
    void add(const Camera& camera, double seconds);
    /// @param camera where it is now, the last key
    CameraPath finish(const Camera& camera);

private:
    std::vector<CameraKey> keys_;
    double now_ = 0; // seconds since the start
};
