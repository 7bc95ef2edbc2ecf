#include "compiler/bake_pose.h"

#include "compiler/gltf_animation.h"
#include "format/keyframes.h"
#include "format/motion.h"

#include <fmt/format.h>

#include <charconv>

namespace
{
using lumicut::fb::ChannelTarget;

/// Those to apply, in order.
Result<std::vector<size_t>> choose(const std::vector<GltfAnimation>& animations, const std::string& wanted)
{
    if (animations.empty())
        return Error{ExitCode::kUsage, "it has no animations; leave --time and --animation out"};
    if (wanted.empty())
        return std::vector<size_t>{0};
    for (size_t i = 0; i < animations.size(); ++i)
        if (animations[i].name == wanted)
            return std::vector{i};
    std::vector<size_t> all;
    for (size_t i = 0; i < animations.size(); ++i)
        all.push_back(i);
    if (wanted == "all")
        return all;
    size_t index = 0;
    const char* const end = wanted.data() + wanted.size();
    const auto [stop, failure] = std::from_chars(wanted.data(), end, index);
    if (failure == std::errc() && stop == end && index < animations.size())
        return std::vector{index};
    std::string names;
    for (const size_t i : all)
        names += fmt::format("{}\"{}\" ({})", i == 0 ? "" : ", ", animations[i].name, i);
    return Error{ExitCode::kUsage, fmt::format("there is no animation \"{}\"; the file has {}", wanted, names)};
}

tinygltf::Value& extension(tinygltf::ExtensionMap& extensions, const char* name)
{
    tinygltf::Value& value = extensions[name];
    if (!value.IsObject())
        value = tinygltf::Value(tinygltf::Value::Object{});
    return value;
}

void setMember(tinygltf::ExtensionMap& extensions, const char* name, const char* member, tinygltf::Value value)
{
    extension(extensions, name).Get<tinygltf::Value::Object>()[member] = std::move(value);
}

void set(tinygltf::Model& model, const AnimationTrack& track, const std::vector<double>& value)
{
    using enum ChannelTarget;
    switch (track.target)
    {
    case Translation:
        model.nodes[track.item].translation = value;
        break;
    case Rotation:
        model.nodes[track.item].rotation = value;
        break;
    case Scale:
        model.nodes[track.item].scale = value;
        break;
    case Weights:
        model.nodes[track.item].weights = value;
        break;
    case Visibility:
        setMember(model.nodes[track.item].extensions, "KHR_node_visibility", "visible", tinygltf::Value(value[0] != 0));
        break;
    case LightColor:
        model.lights[track.item].color = value;
        break;
    case LightIntensity:
        model.lights[track.item].intensity = value[0];
        break;
    case LightInnerCone:
        model.lights[track.item].spot.innerConeAngle = value[0];
        break;
    case LightOuterCone:
        model.lights[track.item].spot.outerConeAngle = value[0];
        break;
    case CameraYfov:
        model.cameras[track.item].perspective.yfov = value[0];
        break;
    case CameraHeight:
        model.cameras[track.item].orthographic.ymag = value[0] / 2;
        break;
    case MaterialBaseColor:
        model.materials[track.item].pbrMetallicRoughness.baseColorFactor = value;
        break;
    case MaterialMetallic:
        model.materials[track.item].pbrMetallicRoughness.metallicFactor = value[0];
        break;
    case MaterialRoughness:
        model.materials[track.item].pbrMetallicRoughness.roughnessFactor = value[0];
        break;
    case MaterialEmissive:
        model.materials[track.item].emissiveFactor = value;
        break;
    case MaterialEmissiveStrength:
        setMember(model.materials[track.item].extensions, "KHR_materials_emissive_strength", "emissiveStrength",
                  tinygltf::Value(value[0]));
        break;
    }
}
} // namespace

Status bakePose(const BakedTime& time, GltfFile& file)
{
    const Result<std::vector<size_t>> chosen = choose(file.animations, time.animation);
    if (!chosen)
        return chosen.error();
    const std::vector<Animation> animations = readAnimations(file, file.warnings);
    for (const size_t i : *chosen)
        for (const AnimationTrack& track : animations[i].tracks)
        {
            const uint32_t width = package::kindOf(track.target)->width;
            std::vector<double> value(width == 0 ? morphWeightCount(file.model, file.model.nodes[track.item]) : width);
            package::sampleKeyframes({.times = track.times,
                                      .values = track.values,
                                      .interpolation = track.interpolation,
                                      .rotation = track.target == ChannelTarget::Rotation},
                                     time.seconds, value);
            set(file.model, track, value);
        }
    file.animations.clear();
    return Success{};
}
