#include "format/pose.h"

#include "format/keyframes.h"
#include "format/motion.h"
#include "format/spot_cone.h"
#include "format/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

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

/// Of rows.
Transform toTransform(const fb::DoubleMatrix& m)
{
    const fb::Double4 &x = m.x(), &y = m.y(), &z = m.z();
    return {{x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z()}, {x.w(), y.w(), z.w()}};
}

/// Whatever keys make of a number, it stays one.
float narrow(double v)
{
    constexpr double kLargest = std::numeric_limits<float>::max();
    return std::isnan(v) ? 0 : float(std::clamp(v, -kLargest, kLargest));
}
gpu::vec3 narrow(const Vec3d& v)
{
    return {narrow(v.x), narrow(v.y), narrow(v.z)};
}

struct NodeState
{
    std::array<double, 3> translation, scale;
    std::array<double, 4> rotation;
    bool hidden;
};

struct LightState
{
    std::array<double, 3> color;
    double intensity, inner_cone, outer_cone;
};

struct CameraState
{
    double yfov, height; // radians, metres
};

struct MaterialState
{
    gpu::Material material;
    std::array<double, 3> emissive{};
    double strength = 1;
};

class Poser
{
public:
    explicit Poser(const Package& package) : package_(package), motion_(*package.motion())
    {
        unit_ = package.meta().unit();
        if (const fb::Vec3d* const o = package.meta().origin())
            origin_ = {o->x(), o->y(), o->z()};
        for (const fb::MotionNode* node : *motion_.nodes())
        {
            const fb::Double4* const r = node->rotation();
            nodes_.push_back(
                {.translation = toArray(node->translation(), 0),
                 .scale = toArray(node->scale(), 1),
                 .rotation = r == nullptr ? std::array{0.0, 0.0, 0.0, 1.0} : std::array{r->x(), r->y(), r->z(), r->w()},
                 .hidden = node->hidden()});
        }
        weights_.assign(motion_.weights()->begin(), motion_.weights()->end());
        for (const fb::MotionLight* light : *motion_.lights())
            lights_.push_back(
                {toArray(light->color(), 1), light->intensity(), light->inner_cone(), light->outer_cone()});
        for (const fb::MotionCamera* camera : *motion_.cameras())
        {
            const fb::Camera& view = *package.meta().cameras()->Get(camera->camera());
            cameras_.push_back({view.vertical_fov(), view.orthographic_height() * unit_});
        }
    }

    void apply(const fb::Clip& clip, double seconds)
    {
        for (const fb::Channel* channel : *clip.channels())
        {
            const fb::MotionNode* const node = kindOf(channel->target())->object == ChannelObject::kNode
                                                   ? motion_.nodes()->Get(channel->index())
                                                   : nullptr;
            const uint32_t width = kindOf(channel->target())->width;
            std::vector<double> value(width == 0 ? node->weight_count() : width);
            sampleKeyframes({.times = {channel->times()->data(), channel->times()->size()},
                             .values = {channel->values()->data(), channel->values()->size()},
                             .interpolation = channel->interpolation(),
                             .rotation = channel->target() == ChannelTarget::Rotation},
                            seconds, value);
            set(*channel, value);
        }
    }

    Pose pose()
    {
        place();
        Pose pose;
        pose.bones.reserve(motion_.bones()->size());
        for (const fb::Bone* bone : *motion_.bones())
            pose.bones.push_back(boneMatrix(*bone));
        for (const double weight : weights_)
            pose.weights.push_back(narrow(weight));
        for (uint32_t i = 0; i < lights_.size(); ++i)
            pose.lights.push_back(posedLight(i));
        for (uint32_t i = 0; i < cameras_.size(); ++i)
            pose.cameras.push_back(posedCamera(i));
        for (const auto& [index, state] : materials_)
            pose.materials.push_back({index, state.material});
        return pose;
    }

private:
    void set(const fb::Channel& channel, const std::vector<double>& value)
    {
        const uint32_t index = channel.index();
        using enum ChannelTarget;
        switch (channel.target())
        {
        case Translation:
            return void(std::copy_n(value.begin(), 3, nodes_[index].translation.begin()));
        case Rotation:
            return void(std::copy_n(value.begin(), 4, nodes_[index].rotation.begin()));
        case Scale:
            return void(std::copy_n(value.begin(), 3, nodes_[index].scale.begin()));
        case Weights:
            return void(
                std::copy(value.begin(), value.end(), weights_.begin() + motion_.nodes()->Get(index)->first_weight()));
        case Visibility:
            return void(nodes_[index].hidden = value[0] == 0);
        case LightColor:
            return void(std::copy_n(value.begin(), 3, lights_[index].color.begin()));
        case LightIntensity:
            return void(lights_[index].intensity = value[0]);
        case LightInnerCone:
            return void(lights_[index].inner_cone = value[0]);
        case LightOuterCone:
            return void(lights_[index].outer_cone = value[0]);
        case CameraYfov:
            return void(cameras_[index].yfov = value[0]);
        case CameraHeight:
            return void(cameras_[index].height = value[0]);
        default:
            return setMaterial(channel.target(), index, value);
        }
    }

    void setMaterial(ChannelTarget target, uint32_t index, const std::vector<double>& value)
    {
        const auto [found, is_new] = materials_.try_emplace(index);
        MaterialState& state = found->second;
        if (is_new)
        {
            state.material = package_.materials()[index];
            for (const fb::MotionMaterial* rest : *motion_.materials())
                if (rest->material() == index)
                {
                    state.emissive = toArray(rest->emissive(), 0);
                    state.strength = rest->strength();
                }
        }
        const auto fraction = [](double v) { return narrow(std::clamp(v, 0.0, 1.0)); };
        gpu::Material& m = state.material;
        using enum ChannelTarget;
        if (target == MaterialBaseColor)
        {
            m.base_color = {fraction(value[0]), fraction(value[1]), fraction(value[2])};
            m.alpha = fraction(value[3]);
        }
        else if (target == MaterialMetallic)
            m.metallic = fraction(value[0]);
        else if (target == MaterialRoughness)
            m.roughness = fraction(value[0]);
        else
        {
            if (target == MaterialEmissive)
                std::copy_n(value.begin(), 3, state.emissive.begin());
            else
                state.strength = value[0];
            const auto channel = [&](size_t i) { return narrow(std::max(0.0, state.emissive[i] * state.strength)); };
            m.emission = {channel(0), channel(1), channel(2)};
        }
    }

    /// World transforms, and what is visible: parents come first.
    void place()
    {
        for (uint32_t i = 0; i < nodes_.size(); ++i)
        {
            const fb::MotionNode& node = *motion_.nodes()->Get(i);
            const NodeState& state = nodes_[i];
            const Transform local = node.matrix() != nullptr
                                        ? toTransform(*node.matrix())
                                        : fromTranslationRotationScale(state.translation, state.rotation, state.scale);
            const bool root = node.parent() < 0;
            to_world_.push_back(root ? local : to_world_[uint32_t(node.parent())] * local);
            shown_.push_back(!state.hidden && (root || shown_[uint32_t(node.parent())]));
        }
    }

    Vec3d inPackage(const Vec3d& p) const { return (p - origin_) * (1 / unit_); }

    gpu::BoneMatrix boneMatrix(const fb::Bone& bone) const
    {
        if (bone.shown_by() >= 0 && !shown_[uint32_t(bone.shown_by())])
            return {};
        const Transform& world = to_world_[bone.node()];
        const Transform m = bone.bind() == nullptr ? world : world * toTransform(*bone.bind());
        const Vec3d t = inPackage({m.translation[0], m.translation[1], m.translation[2]});
        const auto row = [&](size_t r, double translation) -> gpu::vec4
        {
            return {narrow(m.linear[r] / unit_), narrow(m.linear[3 + r] / unit_), narrow(m.linear[6 + r] / unit_),
                    narrow(translation)};
        };
        return {row(0, t.x), row(1, t.y), row(2, t.z)};
    }

    PosedLight posedLight(uint32_t number) const
    {
        const fb::MotionLight& light = *motion_.lights()->Get(number);
        const LightState& state = lights_[number];
        const Transform& world = to_world_[light.node()];
        PosedLight posed{light.light(), package_.lights()[light.light()]};
        const bool directional = posed.light.kind == gpu::kLightDirectional;
        const double scale = shown_[light.node()] ? std::max(0.0, state.intensity) /
                                                        (directional ? 1 : unit_ * unit_) // distances have another unit
                                                  : 0;
        const auto channel = [&](size_t i) { return narrow(std::max(0.0, state.color[i] * scale)); };
        posed.light.emission = {channel(0), channel(1), channel(2)};
        posed.light.p0 = narrow(inPackage(world.point({})));
        posed.light.p1 = directionOr(world.vector({0, 0, -1}), {0, 0, -1});
        if (posed.light.kind == gpu::kLightSpot)
        {
            const double outer = std::clamp(state.outer_cone, 0.0, std::numbers::pi / 2);
            posed.light.p2 = spotCone(float(std::clamp(state.inner_cone, 0.0, outer)), float(outer));
        }
        return posed;
    }

    PosedCamera posedCamera(uint32_t number) const
    {
        constexpr double kNarrowest = 1e-3, kWidest = 3.14; // radians: of 0 and of pi there is no picture
        const fb::MotionCamera& camera = *motion_.cameras()->Get(number);
        const CameraState& state = cameras_[number];
        const Transform& world = to_world_[camera.node()];
        PosedCamera posed{.index = camera.camera()};
        posed.position = narrow(inPackage(world.point({})));
        const Vec3d forward = unitOrZero(world.vector({0, 0, -1}));
        const Vec3d up = unitOrZero(world.vector({0, 1, 0}));
        posed.forward = directionOr(forward, {0, 0, -1});
        const Vec3d f = toDouble(posed.forward);
        const Vec3d other = std::fabs(f.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1};
        posed.up = directionOr(up - f * dot(up, f), toFloat(unitOrZero(other - f * dot(other, f))));
        if (state.height > 0)
            posed.orthographic_height = narrow(std::max(state.height / unit_, 1e-30));
        else
            posed.vertical_fov = narrow(std::clamp(state.yfov, kNarrowest, kWidest));
        return posed;
    }

    const Package& package_;
    const fb::Motion& motion_;
    Vec3d origin_;
    double unit_ = 1;
    std::vector<NodeState> nodes_;
    std::vector<double> weights_;
    std::vector<LightState> lights_;
    std::vector<CameraState> cameras_;
    std::map<uint32_t, MaterialState> materials_; // by index
    std::vector<Transform> to_world_;             // by node
    std::vector<bool> shown_;                     // by node
};
} // namespace

Pose poseAt(const Package& package, std::optional<uint32_t> clip, double seconds)
{
    Poser poser(package);
    const auto& clips = *package.motion()->clips();
    for (uint32_t i = 0; i < clips.size(); ++i)
        if (!clip || *clip == i)
            poser.apply(*clips.Get(i), seconds);
    return poser.pose();
}

Pose poseAtRest(const Package& package)
{
    return Poser(package).pose();
}
} // namespace package
