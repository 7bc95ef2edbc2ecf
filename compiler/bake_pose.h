// A file as its animations show it at one time.
#pragma once
#include "compiler/gltf_file.h"

struct BakedTime
{
    double seconds = 0;    // 0 or more; beyond the last key: as at that one
    std::string animation; // name or index, or "all" at once, of which later ones win; empty: the first
};

/// Sets what the animations set in the model's nodes, lights, cameras and materials, and drops all animations.
/// @return kUsage with a list where the animation does not exist, or where the file has none
Status bakePose(const BakedTime& time, GltfFile& file);
