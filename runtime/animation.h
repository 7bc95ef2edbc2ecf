// The animations of an open package, and what of them is shown.
#pragma once
#include "runtime/camera.h"
#include "runtime/stages/pose.h"

/// What of a package's animations plays.
struct AnimationChoice
{
    enum class What
    {
        kNone, // the scene is as at rest
        kClip,
        kAll, // every clip at once
    };
    What what = What::kNone;
    uint32_t clip = 0; // of kClip
    bool operator==(const AnimationChoice&) const = default;
};

class Animation
{
public:
    /// @param package of `scene`, with motion; borrowed
    Animation(const Device& device, SceneGpu& scene, const package::Package& package);

    /// By clip, the name or "animation N".
    const std::vector<std::string>& names() const { return names_; }
    /// @param name of a clip, its index, "all" or "none"; empty: the first clip
    /// @return kUsage naming what there is
    Result<AnimationChoice> choose(const std::string& name) const;
    /// The next one: clip after clip, then all, then none, then the first clip.
    AnimationChoice after(AnimationChoice choice) const;
    /// Seconds until it is over; 0 where nothing moves.
    double duration(AnimationChoice choice) const;

    /// From the next kernel of `rec` on the scene is as at that time. @param seconds beyond the end: as at the end
    void record(Recorder& rec, AnimationChoice choice, double seconds);
    /// A camera of the package as the last record() has left it. @param index of it, @param camera the same at rest
    Camera posed(size_t index, Camera camera) const;

private:
    const package::Package& package_;
    std::vector<std::string> names_;
    PoseStage stage_;
    package::Poser poser_;
    const package::Pose* pose_; // the last one of `poser_`
    bool has_moved_ = false;
};

/// Where the playing of an animation is.
struct Playback
{
    static constexpr double kFrame = 1 / 30.0; // seconds of a step

    AnimationChoice choice;
    double seconds = 0;
    bool plays = true;
    bool loops = true;
    float speed = 1; // seconds of the animation a second

    /// @param real seconds that have passed, @param duration of the animation, seconds
    void advance(double real, double duration);
    /// Pauses, that much later or earlier.
    void step(double by, double duration);
};
