// Where everything is at a time of an animation: keys, nodes, bones, morph weights, lights and cameras (glTF 2.0, 3.5 and 3.11).
#pragma once
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"
#include "format/package_read.h"

#include <memory>
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

/// Makes poses of a package that has motion, one after the other. References are to the last one that it has made.
class Poser
{
public:
    /// @param package borrowed
    explicit Poser(const Package& package);
    ~Poser();

    /// As poseAt() and poseAtRest() make them; without allocations from the second one on.
    const Pose& at(std::optional<uint32_t> clip, double seconds);
    const Pose& atRest();

private:
    class Tables;
    std::unique_ptr<Tables> tables_;
    Pose pose_;
};

/// The pose of a package that has motion, at a time of one of its clips.
/// @param clip    index into Motion.clips; none: all clips at once, later ones win
/// @param seconds clamped to each channel's keys; callers wrap it for loops
Pose poseAt(const Package& package, std::optional<uint32_t> clip, double seconds);

/// The pose of the package's static geometry: nodes as the file shows them at rest.
Pose poseAtRest(const Package& package);

/// Where a moving vertex is, in single precision; the slow way, for few of them. @param vertex into Package::movingVertices()
gpu::vec3 posedPosition(const Package& package, const Pose& pose, uint32_t vertex);
/// Whether its blended matrix turns surfaces inside out.
bool isMirrored(const Package& package, const Pose& pose, uint32_t vertex);
} // namespace package
