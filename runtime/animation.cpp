#include "runtime/animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace
{
std::vector<std::string> clipNames(const package::Package& package)
{
    std::vector<std::string> names;
    for (const auto* clip : *package.motion()->clips())
        names.push_back(clip->name() != nullptr && clip->name()->size() > 0
                            ? clip->name()->str()
                            : fmt::format("animation {}", names.size()));
    return names;
}
} // namespace

Animation::Animation(const Device& device, SceneGpu& scene, const package::Package& package)
    : package_(package), names_(clipNames(package)), stage_(device, scene, package), poser_(package),
      pose_(&poser_.atRest())
{
}

Result<AnimationChoice> Animation::choose(const std::string& name) const
{
    using What = AnimationChoice::What;
    const auto clip = [](size_t index) { return AnimationChoice{What::kClip, uint32_t(index)}; };
    if (const auto named = std::ranges::find(names_, name); !name.empty() && named != names_.end())
        return clip(size_t(named - names_.begin()));
    if (name == "all")
        return AnimationChoice{What::kAll};
    if (name == "none" || (name.empty() && names_.empty()))
        return AnimationChoice{What::kNone};
    size_t index = 0;
    const char* end = name.data() + name.size();
    const auto [stop, error] = std::from_chars(name.data(), end, index);
    if (name.empty() || (error == std::errc() && stop == end && index < names_.size()))
        return clip(index);
    std::string all;
    for (size_t i = 0; i < names_.size(); ++i)
        all += fmt::format("{} ({}), ", names_[i], i);
    return Error{ExitCode::kUsage,
                 fmt::format("there is no animation '{}'; the package has {}all and none", name, all)};
}

AnimationChoice Animation::after(AnimationChoice choice) const
{
    using What = AnimationChoice::What;
    if (choice.what == What::kAll || (choice.what == What::kNone && names_.empty()))
        return {What::kNone};
    const uint32_t next = choice.what == What::kNone ? 0 : choice.clip + 1;
    return next < names_.size() ? AnimationChoice{What::kClip, next} : AnimationChoice{What::kAll};
}

double Animation::duration(AnimationChoice choice) const
{
    double longest = 0;
    const auto* clips = package_.motion()->clips();
    for (uint32_t i = 0; i < clips->size(); ++i)
        if (choice.what == AnimationChoice::What::kAll ||
            (choice.what == AnimationChoice::What::kClip && choice.clip == i))
            longest = std::max(longest, double(clips->Get(i)->duration()));
    return longest;
}

void Animation::record(Recorder& rec, AnimationChoice choice, double seconds)
{
    if (choice.what == AnimationChoice::What::kNone && !has_moved_)
        return; // as in the package, to the bit
    has_moved_ = true;
    const auto clip = choice.what == AnimationChoice::What::kClip ? std::optional(choice.clip) : std::nullopt;
    pose_ = choice.what == AnimationChoice::What::kNone ? &poser_.atRest() : &poser_.at(clip, seconds);
    stage_.record(rec, *pose_);
}

Camera Animation::posed(size_t index, Camera camera) const
{
    const auto posed = std::ranges::find(pose_->cameras, uint32_t(index), &package::PosedCamera::index);
    if (posed == pose_->cameras.end())
        return camera;
    camera.position = posed->position;
    camera.forward = posed->forward;
    camera.up = posed->up;
    camera.vertical_fov = posed->vertical_fov;
    camera.orthographic_height = posed->orthographic_height;
    return camera;
}

void Playback::step(double by, double duration)
{
    plays = false;
    seconds = std::clamp(seconds + by, 0.0, duration);
}

void Playback::advance(double real, double duration)
{
    if (!plays || !(duration > 0))
        return;
    seconds += real * speed;
    if (seconds <= duration && seconds >= 0)
        return;
    plays = loops;
    seconds = loops ? seconds - duration * std::floor(seconds / duration) : std::clamp(seconds, 0.0, duration);
}
