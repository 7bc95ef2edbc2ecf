// What channels of an animation set, before it is placed: properties of nodes, lights, cameras and materials.
#pragma once
#include "format/keyframes.h"
#include "format/package_read.h"
#include "format/vec3d.h"

#include <array>
#include <vector>

namespace package
{
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
    uint32_t index; // into Package::materials()
    gpu::Material material;
    std::array<double, 3> emissive{};
    double strength = 1;
};

/// Whatever keys make of a number, it stays one.
float narrow(double v);
inline gpu::vec3 narrow(const Vec3d& v)
{
    return {narrow(v.x), narrow(v.y), narrow(v.z)};
}

class PoseState
{
public:
    /// At rest. @param package has motion; borrowed
    explicit PoseState(const Package& package);

    void rest();
    uint32_t clipCount() const { return uint32_t(clips_.size()); }
    /// A clip's channels; what it does not set stays. @param clip index into Motion.clips
    void apply(uint32_t clip, double seconds);

    const std::vector<NodeState>& nodes() const { return now_.nodes; }
    const std::vector<double>& weights() const { return now_.weights; }
    const std::vector<LightState>& lights() const { return now_.lights; }
    const std::vector<CameraState>& cameras() const { return now_.cameras; }
    const std::vector<MaterialState>& materials() const { return materials_; } // set since rest()

private:
    struct Track // a channel, unpacked
    {
        lumicut::fb::ChannelTarget target;
        uint32_t index;
        uint32_t first_weight;
        uint32_t width; // values a key
        Keyframes keys;
    };
    struct Values
    {
        std::vector<NodeState> nodes;
        std::vector<double> weights;
        std::vector<LightState> lights;
        std::vector<CameraState> cameras;
    };

    Track trackOf(const lumicut::fb::Channel& channel) const;
    void set(const Track& track);
    void setMaterial(const Track& track);
    MaterialState& materialAt(uint32_t index);

    const Package& package_;
    Values rest_, now_;
    std::vector<MaterialState> materials_;
    std::vector<std::vector<Track>> clips_;
    std::vector<double> value_; // of the channel at hand
};
} // namespace package
