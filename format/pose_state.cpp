#include "format/pose_state.h"

#include "format/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace package
{
namespace
{
namespace fb = lumicut::fb;
using fb::ChannelTarget;

std::array<double, 3> toArray(const fb::Double3* v, double fallback)
{
    return v == nullptr ? std::array{fallback, fallback, fallback} : std::array{v->x(), v->y(), v->z()};
}
} // namespace

float narrow(double v)
{
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::isnan(v) ? 0 : float(std::clamp(v, -kLargest, kLargest));
}

PoseState::PoseState(const Package& package) : package_(package)
{
    const fb::Motion& motion = *package.motion();
    for (const fb::MotionNode* node : *motion.nodes())
    {
        const fb::Double4* const r = node->rotation();
        rest_.nodes.push_back(
            {.translation = toArray(node->translation(), 0),
             .scale = toArray(node->scale(), 1),
             .rotation = r == nullptr ? std::array{0.0, 0.0, 0.0, 1.0} : std::array{r->x(), r->y(), r->z(), r->w()},
             .hidden = node->hidden()});
    }
    rest_.weights.assign(motion.weights()->begin(), motion.weights()->end());
    for (const fb::MotionLight* light : *motion.lights())
        rest_.lights.push_back(
            {toArray(light->color(), 1), light->intensity(), light->inner_cone(), light->outer_cone()});
    for (const fb::MotionCamera* camera : *motion.cameras())
    {
        const fb::Camera& view = *package.meta().cameras()->Get(camera->camera());
        rest_.cameras.push_back({view.vertical_fov(), view.orthographic_height() * package.meta().unit()});
    }
    for (const fb::Clip* clip : *motion.clips())
    {
        std::vector<Track>& tracks = clips_.emplace_back();
        for (const fb::Channel* channel : *clip->channels())
            tracks.push_back(trackOf(*channel));
    }
    rest();
}

PoseState::Track PoseState::trackOf(const fb::Channel& channel) const
{
    const ChannelKind kind = *kindOf(channel.target());
    const fb::MotionNode* const node =
        kind.object == ChannelObject::kNode ? package_.motion()->nodes()->Get(channel.index()) : nullptr;
    return {.target = channel.target(),
            .index = channel.index(),
            .first_weight = node == nullptr ? 0 : node->first_weight(),
            .width = kind.width == 0 ? node->weight_count() : kind.width,
            .keys = {.times = {channel.times()->data(), channel.times()->size()},
                     .values = {channel.values()->data(), channel.values()->size()},
                     .interpolation = channel.interpolation(),
                     .rotation = channel.target() == ChannelTarget::Rotation}};
}

void PoseState::rest()
{
    now_ = rest_;
    materials_.clear();
}

void PoseState::apply(uint32_t clip, double seconds)
{
    for (const Track& track : clips_[clip])
    {
        value_.resize(track.width);
        sampleKeyframes(track.keys, seconds, value_);
        set(track);
    }
}

void PoseState::set(const Track& track)
{
    const auto copyTo = [&](auto& to) { std::copy(value_.begin(), value_.end(), to.begin()); };
    using enum ChannelTarget;
    switch (track.target)
    {
    case Translation:
        return copyTo(now_.nodes[track.index].translation);
    case Rotation:
        return copyTo(now_.nodes[track.index].rotation);
    case Scale:
        return copyTo(now_.nodes[track.index].scale);
    case Weights:
        return void(std::copy(value_.begin(), value_.end(), now_.weights.begin() + track.first_weight));
    case Visibility:
        return void(now_.nodes[track.index].hidden = value_[0] == 0);
    case LightColor:
        return copyTo(now_.lights[track.index].color);
    case LightIntensity:
        return void(now_.lights[track.index].intensity = value_[0]);
    case LightInnerCone:
        return void(now_.lights[track.index].inner_cone = value_[0]);
    case LightOuterCone:
        return void(now_.lights[track.index].outer_cone = value_[0]);
    case CameraYfov:
        return void(now_.cameras[track.index].yfov = value_[0]);
    case CameraHeight:
        return void(now_.cameras[track.index].height = value_[0]);
    default:
        return setMaterial(track);
    }
}

/// As the file has it where no channel has set it before.
MaterialState& PoseState::materialAt(uint32_t index)
{
    if (const auto there = std::ranges::find(materials_, index, &MaterialState::index); there != materials_.end())
        return *there;
    MaterialState& state =
        materials_.emplace_back(MaterialState{.index = index, .material = package_.materials()[index]});
    for (const fb::MotionMaterial* rest : *package_.motion()->materials())
        if (rest->material() == index)
        {
            state.emissive = toArray(rest->emissive(), 0);
            state.strength = rest->strength();
        }
    return state;
}

void PoseState::setMaterial(const Track& track)
{
    MaterialState& state = materialAt(track.index);
    const auto fraction = [](double v) { return narrow(std::clamp(v, 0.0, 1.0)); };
    gpu::Material& m = state.material;
    using enum ChannelTarget;
    if (track.target == MaterialBaseColor)
    {
        m.base_color = {fraction(value_[0]), fraction(value_[1]), fraction(value_[2])};
        m.alpha = fraction(value_[3]);
    }
    else if (track.target == MaterialMetallic)
        m.metallic = fraction(value_[0]);
    else if (track.target == MaterialRoughness)
        m.roughness = fraction(value_[0]);
    else
    {
        if (track.target == MaterialEmissive)
            std::copy_n(value_.begin(), 3, state.emissive.begin());
        else
            state.strength = value_[0];
        const auto channel = [&](size_t i) { return narrow(std::max(0.0, state.emissive[i] * state.strength)); };
        m.emission = {channel(0), channel(1), channel(2)};
    }
}
} // namespace package
