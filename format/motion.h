// What the channels of a MOTN chunk set.
#pragma once
#include "format/motion_generated.h"

#include <optional>

namespace package
{
/// The array that a channel's index refers to.
enum class ChannelObject
{
    kNode,     // Motion.nodes
    kLight,    // Motion.lights
    kCamera,   // Motion.cameras
    kMaterial, // chunk MATL
};

struct ChannelKind
{
    ChannelObject object = ChannelObject::kNode;
    uint32_t width = 0; // values a key; 0: as many as the node has morph weights
};

/// @return nothing for a target that does not exist
inline std::optional<ChannelKind> kindOf(lumicut::fb::ChannelTarget target)
{
    using enum lumicut::fb::ChannelTarget;
    switch (target)
    {
    case Translation:
    case Scale:
        return ChannelKind{ChannelObject::kNode, 3};
    case Rotation:
        return ChannelKind{ChannelObject::kNode, 4};
    case Weights:
        return ChannelKind{ChannelObject::kNode, 0};
    case Visibility:
        return ChannelKind{ChannelObject::kNode, 1};
    case LightColor:
        return ChannelKind{ChannelObject::kLight, 3};
    case LightIntensity:
    case LightInnerCone:
    case LightOuterCone:
        return ChannelKind{ChannelObject::kLight, 1};
    case CameraYfov:
    case CameraHeight:
        return ChannelKind{ChannelObject::kCamera, 1};
    case MaterialBaseColor:
        return ChannelKind{ChannelObject::kMaterial, 4};
    case MaterialEmissive:
        return ChannelKind{ChannelObject::kMaterial, 3};
    case MaterialEmissiveStrength:
    case MaterialMetallic:
    case MaterialRoughness:
        return ChannelKind{ChannelObject::kMaterial, 1};
    }
    return std::nullopt;
}
} // namespace package
