// An animation that plays from frame to frame of a measurement.
#pragma once
#include "runtime/animation.h"
#include "tools/bench/opened.h"

#include <memory>

class PlayedAnimation
{
public:
    /// @param opened borrowed, @param name as Animation::choose() takes it; empty: nothing plays
    /// @return kUsage where the package has no such animation
    static Result<PlayedAnimation> create(const OpenedPackage& opened, const std::string& name,
                                          double frames_per_second);

    /// The scene as it is in a frame, from the next kernel of `rec` on; over and over. Frames before the first are negative.
    void show(Recorder& rec, int32_t frame);
    /// Of what show() has shown; 0: nothing plays.
    uint64_t hash() const { return hash_; }

private:
    explicit PlayedAnimation(double frames_per_second) : frames_per_second_(frames_per_second) {}

    std::unique_ptr<Animation> animation_; // none: nothing plays
    AnimationChoice choice_;
    double frames_per_second_;
    uint64_t hash_ = 0;
};
