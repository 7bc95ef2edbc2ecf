// What moving geometry does to the power of triangles that emit: they grow, shrink and are hidden.
#pragma once
#include "format/pose.h"
#include "runtime/scene_lights.h"

#include <optional>
#include <span>
#include <vector>

/// Lights that are about to change, each once.
class LightChanges
{
public:
    /// Nothing changes yet. @param lights as they are; borrowed
    void restart(std::span<const gpu::Light> lights);
    /// The light as it will be.
    gpu::Light& of(uint32_t index);
    std::span<const ChangedLight> changed() const { return changed_; }

private:
    std::span<const gpu::Light> lights_;
    std::vector<ChangedLight> changed_;
    std::vector<uint32_t> places_; // by light: in changed_, or gpu::kNone
};

class EmitterShapes
{
public:
    /// @param package with motion; borrowed
    explicit EmitterShapes(const package::Package& package);

    /// Corners of moving triangles that emit, where their area can be another than in the call before. What a single bone moves has
    /// the areas of the package while the bone turns and travels. After each call areas depend on its pose alone, to the bit.
    void change(const package::Pose& pose, LightChanges& changes);

private:
    struct Triangle
    {
        uint32_t light;
        gpu::uvec3 vertices; // into Package::movingVertices()
    };
    struct Stretch // dot products of a bone's columns: lengths and angles after it follow from them
    {
        float xx, yy, zz, xy, xz, yz;
    };
    struct Object
    {
        std::vector<Triangle> triangles;
        std::optional<uint32_t> bone; // that alone moves it
        Stretch rest{};               // of that bone in the package
        bool as_in_package = true;    // its areas, since the last call
    };
    static Stretch stretchOf(const gpu::BoneMatrix& m);
    static bool isAlike(const Stretch& a, const Stretch& b);

    const package::Package& package_;
    std::vector<Object> objects_; // that have such triangles
};
