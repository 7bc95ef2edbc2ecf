// The animations of a glTF file: core channels and those of KHR_animation_pointer.
#pragma once
#include "compiler/gltf_file.h"
#include "format/motion_generated.h"

#include <string>
#include <vector>

/// What one channel sets over time, of an item of the file.
struct AnimationTrack
{
    lumicut::fb::ChannelTarget target{}; // decides what `item` counts: nodes, lights, cameras or materials of the file
    size_t item = 0;                     // in range
    lumicut::fb::Interpolation interpolation{};
    std::vector<float> times;  // as lumicut::fb::Channel has them
    std::vector<float> values; // likewise
};

struct Animation
{
    std::string name;
    float duration = 0; // seconds: the largest key time, of tracks that were left out, too
    std::vector<AnimationTrack> tracks;
};

/// All animations of the file, as many as it has. Channels that are damaged, or that set what is not supported, are left out
/// with a warning; so are those that keep what they set as it is at rest.
std::vector<Animation> readAnimations(const GltfFile& file, Warnings& warnings);

/// How many morph weights a node's mesh has.
uint32_t morphWeightCount(const tinygltf::Model& model, const tinygltf::Node& node);
