#include "compiler/gltf_animation.h"

#include "compiler/gltf_accessor.h"
#include "format/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace
{
using lumicut::fb::ChannelTarget;
using lumicut::fb::Interpolation;

struct Target
{
    ChannelTarget property;
    size_t item;
};

/// A property that a pointer names, with the number of its item in place of the star.
struct PointerForm
{
    std::string_view before, after;
    ChannelTarget property;
};

constexpr PointerForm kPointers[] = {
    {"/nodes/", "/translation", ChannelTarget::Translation},
    {"/nodes/", "/rotation", ChannelTarget::Rotation},
    {"/nodes/", "/scale", ChannelTarget::Scale},
    {"/nodes/", "/weights", ChannelTarget::Weights},
    {"/nodes/", "/extensions/KHR_node_visibility/visible", ChannelTarget::Visibility},
    {"/extensions/KHR_lights_punctual/lights/", "/color", ChannelTarget::LightColor},
    {"/extensions/KHR_lights_punctual/lights/", "/intensity", ChannelTarget::LightIntensity},
    {"/extensions/KHR_lights_punctual/lights/", "/spot/innerConeAngle", ChannelTarget::LightInnerCone},
    {"/extensions/KHR_lights_punctual/lights/", "/spot/outerConeAngle", ChannelTarget::LightOuterCone},
    {"/cameras/", "/perspective/yfov", ChannelTarget::CameraYfov},
    {"/cameras/", "/orthographic/ymag", ChannelTarget::CameraHeight},
    {"/materials/", "/pbrMetallicRoughness/baseColorFactor", ChannelTarget::MaterialBaseColor},
    {"/materials/", "/pbrMetallicRoughness/metallicFactor", ChannelTarget::MaterialMetallic},
    {"/materials/", "/pbrMetallicRoughness/roughnessFactor", ChannelTarget::MaterialRoughness},
    {"/materials/", "/emissiveFactor", ChannelTarget::MaterialEmissive},
    {"/materials/", "/extensions/KHR_materials_emissive_strength/emissiveStrength",
     ChannelTarget::MaterialEmissiveStrength},
};

/// @return nothing where the pointer names something else
std::optional<Target> resolve(std::string_view pointer)
{
    for (const PointerForm& form : kPointers)
    {
        if (!pointer.starts_with(form.before) || !pointer.ends_with(form.after) ||
            pointer.size() <= form.before.size() + form.after.size())
            continue;
        const std::string_view number =
            pointer.substr(form.before.size(), pointer.size() - form.before.size() - form.after.size());
        size_t item = 0;
        const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), item);
        if (failure == std::errc() && end == number.data() + number.size())
            return Target{form.property, item};
    }
    return std::nullopt;
}

/// As a pointer: core channels name a node and its property.
std::string pointerOf(const GltfChannel& channel)
{
    return channel.path == "pointer" ? channel.pointer : fmt::format("/nodes/{}/{}", channel.node, channel.path);
}

size_t itemCount(const tinygltf::Model& model, ChannelTarget property)
{
    switch (package::kindOf(property)->object)
    {
    case package::ChannelObject::kNode:
        return model.nodes.size();
    case package::ChannelObject::kLight:
        return model.lights.size();
    case package::ChannelObject::kCamera:
        return model.cameras.size();
    case package::ChannelObject::kMaterial:
        return model.materials.size();
    }
    return 0;
}

Error invalid(std::string text)
{
    return {ExitCode::kInvalid, std::move(text)};
}

Result<Interpolation> interpolationOf(const GltfChannel& channel)
{
    if (channel.interpolation == "STEP")
        return Interpolation::Step;
    if (channel.interpolation == "LINEAR")
        return Interpolation::Linear;
    if (channel.interpolation == "CUBICSPLINE")
        return Interpolation::CubicSpline;
    return invalid("its interpolation does not exist");
}

Status checkTimes(const std::vector<float>& times)
{
    for (size_t i = 0; i < times.size(); ++i)
        if (!std::isfinite(times[i]) || times[i] < 0 || (i > 0 && times[i] <= times[i - 1]))
            return invalid(fmt::format("its key {} is at {} s: times must rise from 0 on", i, times[i]));
    return Success{};
}

Result<AnimationTrack> readTrack(const GltfFile& file, const GltfChannel& channel, const Target& target)
{
    const tinygltf::Model& model = file.model;
    if (target.item >= itemCount(model, target.property))
        return invalid("what it sets does not exist");
    uint32_t width = package::kindOf(target.property)->width;
    if (package::kindOf(target.property)->object == package::ChannelObject::kNode)
    {
        const tinygltf::Node& node = model.nodes[target.item];
        if (target.property <= ChannelTarget::Scale && !node.matrix.empty())
            return invalid("its node has a matrix, which cannot be animated");
        if (width == 0)
            width = morphWeightCount(model, node);
        if (width == 0)
            return invalid("its node's mesh has no morph targets");
    }
    if ((target.property == ChannelTarget::CameraYfov && model.cameras[target.item].type != "perspective") ||
        (target.property == ChannelTarget::CameraHeight && model.cameras[target.item].type != "orthographic"))
        return invalid("its camera is of another type");
    const Result<Interpolation> interpolation = interpolationOf(channel);
    if (!interpolation)
        return interpolation.error();
    Result<FloatArray> times = readFloats(model, channel.times, 1, 1);
    Result<FloatArray> values = readFloats(model, channel.values, 1, 4);
    if (!times || !values)
        return times ? values.error() : times.error();
    const size_t stride = size_t(width) * (*interpolation == Interpolation::CubicSpline ? 3 : 1);
    if (times->count == 0 || values->values.size() != times->count * stride)
        return invalid(fmt::format("it has {} values for {} keys of {}", values->values.size(), times->count, stride));
    if (!std::all_of(values->values.begin(), values->values.end(), [](float v) { return std::isfinite(v); }))
        return invalid("a value of it is not finite");
    if (const Status status = checkTimes(times->values); !status)
        return status.error();
    AnimationTrack track{target.property, target.item, *interpolation, std::move(times->values),
                         std::move(values->values)};
    if (target.property == ChannelTarget::Visibility)
        track.interpolation = Interpolation::Step;
    if (target.property == ChannelTarget::CameraHeight)
        for (float& value : track.values)
            value *= 2; // a file has half of it
    return track;
}

std::vector<double> orElse(const std::vector<double>& given, std::vector<double> fallback)
{
    return given.size() == fallback.size() ? given : fallback;
}

/// The node's value where no animation sets it; empty for other items.
std::vector<double> valueAtRest(const tinygltf::Model& model, const AnimationTrack& track)
{
    if (package::kindOf(track.target)->object != package::ChannelObject::kNode)
        return {};
    const tinygltf::Node& node = model.nodes[track.item];
    switch (track.target)
    {
    case ChannelTarget::Translation:
        return orElse(node.translation, {0, 0, 0});
    case ChannelTarget::Rotation:
        return orElse(node.rotation, {0, 0, 0, 1});
    case ChannelTarget::Scale:
        return orElse(node.scale, {1, 1, 1});
    case ChannelTarget::Weights:
    {
        std::vector<double> weights = node.weights.empty() ? model.meshes[size_t(node.mesh)].weights : node.weights;
        weights.resize(morphWeightCount(model, node));
        return weights;
    }
    default:
        return {};
    }
}

/// Exporters write channels for all nodes, moving or not.
bool keepsRest(const tinygltf::Model& model, const AnimationTrack& track)
{
    const std::vector<double> rest = valueAtRest(model, track);
    if (rest.empty())
        return false;
    const bool cubic = track.interpolation == Interpolation::CubicSpline;
    const size_t n = rest.size();
    for (size_t i = 0; i < track.values.size(); ++i)
    {
        const bool tangent = cubic && (i / n) % 3 != 1;
        if (track.values[i] != (tangent ? 0.0f : float(rest[i % n])))
            return false;
    }
    return true;
}
} // namespace

std::vector<Animation> readAnimations(const GltfFile& file, Warnings& warnings)
{
    std::vector<Animation> animations;
    std::vector<std::string> unsupported;
    for (size_t a = 0; a < file.animations.size(); ++a)
    {
        Animation& animation = animations.emplace_back(Animation{file.animations[a].name, 0, {}});
        for (size_t c = 0; c < file.animations[a].channels.size(); ++c)
        {
            const GltfChannel& channel = file.animations[a].channels[c];
            if (channel.path != "pointer" && channel.node == -1)
                continue; // glTF 2.0, 3.11: an extension may say what it sets; else it is to be ignored
            const std::optional<Target> target = resolve(pointerOf(channel));
            if (!target)
            {
                if (unsupported.size() < 4)
                    unsupported.push_back(pointerOf(channel).substr(0, 100));
                continue;
            }
            Result<AnimationTrack> track = readTrack(file, channel, *target);
            if (!track)
            {
                warnings.push_back(warningOf(WarningKind::kMalformed, track.error(),
                                             fmt::format("/animations/{}/channels/{}", a, c), "it is left out"));
                continue;
            }
            animation.duration = std::max(animation.duration, track->times.back());
            if (!keepsRest(file.model, *track))
                animation.tracks.push_back(std::move(*track));
        }
    }
    if (!unsupported.empty())
        warnings.push_back({WarningKind::kLeftOut, "/animations",
                            fmt::format("animations of some properties are left out: {}{}", unsupported[0],
                                        unsupported.size() > 1 ? " and others" : ""),
                            ""});
    return animations;
}

uint32_t morphWeightCount(const tinygltf::Model& model, const tinygltf::Node& node)
{
    size_t count = 0;
    if (node.mesh != -1)
        for (const tinygltf::Primitive& primitive : model.meshes[size_t(node.mesh)].primitives)
            count = std::max(count, primitive.targets.size());
    return uint32_t(count);
}
