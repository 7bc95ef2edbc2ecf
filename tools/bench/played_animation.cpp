#include "tools/bench/played_animation.h"

#include <bit>
#include <cmath>

Result<PlayedAnimation> PlayedAnimation::create(const OpenedPackage& opened, const std::string& name,
                                                double frames_per_second)
{
    PlayedAnimation played(frames_per_second);
    if (name.empty())
        return played;
    if (opened.package.motion() == nullptr)
        return Error{ExitCode::kUsage, "nothing in the package moves; leave --animation out"};
    played.animation_ = std::make_unique<Animation>(*opened.device, *opened.scene, opened.package);
    const auto choice = played.animation_->choose(name);
    if (!choice)
        return choice.error();
    played.choice_ = *choice;
    return played;
}

void PlayedAnimation::show(Recorder& rec, int32_t frame)
{
    const double duration = animation_ ? animation_->duration(choice_) : 0;
    if (!(duration > 0))
        return;
    const double seconds = frame / frames_per_second_, rest = seconds - duration * std::floor(seconds / duration);
    animation_->record(rec, choice_, rest);
    hash_ = std::bit_cast<uint64_t>(rest + 1) * 0x9e3779b97f4a7c15u + uint64_t(choice_.what) * 31 + choice_.clip + 1;
}
