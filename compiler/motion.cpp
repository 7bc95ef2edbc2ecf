#include "compiler/motion.h"

#include "format/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
namespace fb = lumicut::fb;
using fb::ChannelTarget;

std::unique_ptr<fb::Double3> triple(const std::vector<double>& v)
{
    return v.size() == 3 ? std::make_unique<fb::Double3>(v[0], v[1], v[2]) : nullptr;
}

std::unique_ptr<fb::Double4> unitQuaternion(const std::vector<double>& q)
{
    if (q.size() != 4)
        return nullptr;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0))
        return nullptr;
    return std::make_unique<fb::Double4>(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
}

std::unique_ptr<fb::DoubleMatrix> rows(const Transform& t)
{
    const auto row = [&](size_t r)
    { return fb::Double4(t.linear[r], t.linear[3 + r], t.linear[6 + r], t.translation[r]); };
    return std::make_unique<fb::DoubleMatrix>(row(0), row(1), row(2));
}

bool isIdentity(const Transform& t)
{
    return t.linear == Transform{}.linear && t.translation == Transform{}.translation;
}

std::unique_ptr<fb::BoneT> bone(uint32_t node, const Transform& bind, uint32_t shown_by)
{
    auto result = std::make_unique<fb::BoneT>();
    result->node = node;
    result->shown_by = int32_t(shown_by);
    if (!isIdentity(bind))
        result->bind = rows(bind);
    return result;
}
} // namespace

MovingNodes::MovingNodes(const tinygltf::Model& model, const std::vector<Animation>& animations)
    : places(model.nodes.size()), morphs(model.nodes.size()), appears(model.nodes.size())
{
    std::vector<size_t> pending;
    const auto move = [&](size_t node)
    {
        if (places[node])
            return;
        places[node] = true;
        pending.push_back(node);
    };
    for (const Animation& animation : animations)
        for (const AnimationTrack& track : animation.tracks)
        {
            if (track.target == ChannelTarget::Weights)
                morphs[track.item] = true;
            else if (package::kindOf(track.target)->object == package::ChannelObject::kNode)
                move(track.item);
            if (track.target == ChannelTarget::Visibility)
                appears[track.item] = true;
        }
    while (!pending.empty())
    {
        const tinygltf::Node& node = model.nodes[pending.back()];
        pending.pop_back();
        for (const int child : node.children)
            move(size_t(child));
    }
}

MotionBuilder::MotionBuilder(const tinygltf::Model& model, const std::vector<Animation>& animations)
    : model_(model), animations_(animations), parents_(model.nodes.size(), -1)
{
    for (size_t i = 0; i < model.nodes.size(); ++i)
        for (const int child : model.nodes[i].children)
            parents_[size_t(child)] = int(i);
}

uint32_t MotionBuilder::node(size_t of_file)
{
    std::vector<size_t> missing;
    for (int at = int(of_file); at != -1 && !nodes_.contains(size_t(at)); at = parents_[size_t(at)])
        missing.push_back(size_t(at));
    std::reverse(missing.begin(), missing.end()); // parents first
    for (const size_t index : missing)
    {
        const tinygltf::Node& from = model_.nodes[index];
        auto to = std::make_unique<fb::MotionNodeT>();
        to->name = from.name;
        to->parent = parents_[index] == -1 ? -1 : int32_t(nodes_.at(size_t(parents_[index])));
        if (from.matrix.empty())
        {
            to->translation = triple(from.translation);
            to->rotation = unitQuaternion(from.rotation);
            to->scale = triple(from.scale);
        }
        else if (const auto local = localTransform(from, index))
            to->matrix = rows(*local);
        const auto visibility = from.extensions.find("KHR_node_visibility");
        to->hidden = visibility != from.extensions.end() && visibility->second.Get("visible").IsBool() &&
                     !visibility->second.Get("visible").Get<bool>();
        to->first_weight = uint32_t(motion_->tables.weights.size());
        to->weight_count = morphWeightCount(model_, from);
        if (to->weight_count > 0)
        {
            std::vector<double> weights =
                from.weights.empty() ? model_.meshes[size_t(from.mesh)].weights : from.weights;
            weights.resize(to->weight_count);
            for (const double weight : weights)
                motion_->tables.weights.push_back(float(weight));
        }
        nodes_[index] = uint32_t(motion_->tables.nodes.size());
        motion_->tables.nodes.push_back(std::move(to));
    }
    return nodes_.at(of_file);
}

MovingPlace MotionBuilder::addObject(const MeshInstance& instance, const SkinPose* pose)
{
    MovingPlace place{.node = node(instance.node)};
    auto& bones = motion_->tables.bones;
    place.hidden = instance.hidden;
    place.first_weight = motion_->tables.nodes[place.node]->first_weight;
    place.node_bone = uint32_t(bones.size());
    bones.push_back(bone(place.node, instance.instance, place.node));
    place.first_bone = uint32_t(bones.size());
    for (size_t j = 0; pose != nullptr && j < pose->nodes.size(); ++j)
        bones.push_back(bone(node(pose->nodes[j]), pose->binds[j], place.node));
    return place;
}

void MotionBuilder::addLight(uint32_t number, size_t of_file, const tinygltf::Light& light)
{
    constexpr double kRightAngle = std::numbers::pi / 2;
    auto to = std::make_unique<fb::MotionLightT>();
    to->light = number;
    to->node = node(of_file);
    to->color = light.color.size() == 3 ? triple(light.color) : std::make_unique<fb::Double3>(1.0, 1.0, 1.0);
    to->intensity = light.intensity;
    to->outer_cone = std::clamp(light.spot.outerConeAngle, 0.0, kRightAngle);
    to->inner_cone = std::clamp(light.spot.innerConeAngle, 0.0, to->outer_cone);
    lights_.emplace(size_t(lightOf(model_.nodes[of_file])), uint32_t(motion_->tables.lights.size()));
    motion_->tables.lights.push_back(std::move(to));
}

void MotionBuilder::addCamera(uint32_t number, size_t of_file)
{
    auto to = std::make_unique<fb::MotionCameraT>();
    to->camera = number;
    to->node = node(of_file);
    cameras_.emplace(size_t(model_.nodes[of_file].camera), uint32_t(motion_->tables.cameras.size()));
    motion_->tables.cameras.push_back(std::move(to));
}

std::vector<uint32_t> MotionBuilder::itemsOf(const AnimationTrack& track, const std::vector<int>& material_of) const
{
    const auto all = [&](const std::multimap<size_t, uint32_t>& items)
    {
        std::vector<uint32_t> found;
        const auto [first, end] = items.equal_range(track.item);
        for (auto it = first; it != end; ++it)
            found.push_back(it->second);
        return found;
    };
    switch (package::kindOf(track.target)->object)
    {
    case package::ChannelObject::kNode:
        return nodes_.contains(track.item) ? std::vector{nodes_.at(track.item)} : std::vector<uint32_t>{};
    case package::ChannelObject::kLight:
        return all(lights_);
    case package::ChannelObject::kCamera:
        return all(cameras_);
    case package::ChannelObject::kMaterial:
        return track.item < material_of.size() && material_of[track.item] >= 0
                   ? std::vector{uint32_t(material_of[track.item])}
                   : std::vector<uint32_t>{};
    }
    return {};
}

void MotionBuilder::addEmission(size_t of_file, uint32_t material)
{
    auto& list = motion_->tables.materials;
    if (std::any_of(list.begin(), list.end(), [&](const auto& m) { return m->material == material; }))
        return;
    const tinygltf::Material& from = model_.materials[of_file];
    auto to = std::make_unique<fb::MotionMaterialT>();
    to->material = material;
    to->emissive =
        from.emissiveFactor.size() == 3 ? triple(from.emissiveFactor) : std::make_unique<fb::Double3>(0.0, 0.0, 0.0);
    const auto strength = from.extensions.find("KHR_materials_emissive_strength");
    if (strength != from.extensions.end() && strength->second.Get("emissiveStrength").IsNumber())
        to->strength = strength->second.Get("emissiveStrength").GetNumberAsDouble();
    list.push_back(std::move(to));
}

void MotionBuilder::addChannels(const Animation& animation, const std::vector<int>& material_of, fb::ClipT& clip)
{
    for (const AnimationTrack& track : animation.tracks)
        for (const uint32_t item : itemsOf(track, material_of))
        {
            if (track.target == ChannelTarget::MaterialEmissive ||
                track.target == ChannelTarget::MaterialEmissiveStrength)
                addEmission(track.item, item);
            auto channel = std::make_unique<fb::ChannelT>();
            channel->target = track.target;
            channel->index = item;
            channel->interpolation = track.interpolation;
            channel->times = track.times;
            channel->values = track.values;
            clip.channels.push_back(std::move(channel));
        }
}

std::shared_ptr<MotionData> MotionBuilder::finish(const std::vector<int>& material_of)
{
    bool moves = false;
    for (const Animation& animation : animations_)
    {
        auto clip = std::make_unique<fb::ClipT>();
        clip->name = animation.name;
        clip->duration = animation.duration;
        addChannels(animation, material_of, *clip);
        moves = moves || !clip->channels.empty();
        motion_->tables.clips.push_back(std::move(clip));
    }
    return moves ? motion_ : nullptr;
}
