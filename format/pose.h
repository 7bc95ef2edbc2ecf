// Where everything is at a time of an animation: keys, nodes, bones, morph weights, lights and cameras (glTF 2.0, 3.5 and 3.11).
#pragma once
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"
#include "format/package_read.h"

#include <optional>
#include <vector>

namespace package
{
struct PosedLight
{
    uint32_t index;   // into Package::lights()
    gpu::Light light; // with the kind and pmf of the package's; emits nothing while its node is hidden
};

struct PosedCamera
{
    uint32_t index;       // into Meta.cameras
    gpu::vec3 position{}; // the package's units
    gpu::vec3 forward{};  // unit
    gpu::vec3 up{};       // unit, orthogonal to forward
    float vertical_fov = 0;
    float orthographic_height = 0;
};

struct PosedMaterial
{
    uint32_t index; // into Package::materials()
    gpu::Material material;
};

struct Pose
{
    std::vector<gpu::BoneMatrix>
        bones;                  // by Motion.bones; all 0 where hidden: such triangles have no area and are never met
    std::vector<float> weights; // by Motion.weights
    std::vector<PosedLight> lights;       // by Motion.lights
    std::vector<PosedCamera> cameras;     // by Motion.cameras
    std::vector<PosedMaterial> materials; // those that channels of the clip set
};

/// The pose of a package that has motion, at a time of one of its clips.
/// @param clip    index into Motion.clips; none: all clips at once, later ones win
/// @param seconds clamped to each channel's keys; callers wrap it for loops
Pose poseAt(const Package& package, std::optional<uint32_t> clip, double seconds);

/// The pose of the package's static geometry: nodes as the file shows them at rest.
Pose poseAtRest(const Package& package);
} // namespace package
