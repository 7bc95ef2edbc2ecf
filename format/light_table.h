// How lights are picked: by power. Compiler and player derive powers, probabilities and alias tables here and nowhere else.
#pragma once
#include "format/gpu_scene.h"
#include "format/package_read.h"

#include <span>
#include <vector>

namespace package
{
/// Of what a scene needs to be told for the power of directional and environment lights.
struct LightSurroundings
{
    double radius = 0;            // of the sphere about the scene's box, at rest
    gpu::vec3 average_radiance{}; // of the environment, over the sphere
};

/// Lights below this fraction of the total have no power: their probability would be too small to divide by.
constexpr double kLeastPowerShare = 1e-30;

double sphereRadius(gpu::vec3 box_min, gpu::vec3 box_max);

/// W, luminance: point 4 pi I; spot over its cone; directional E pi R^2 and environment pi R^2 x radiance integrated over the
/// sphere, R the surroundings' radius; triangle pi A x emission, twice that where it emits on both sides.
/// @param yield mean over a triangle of what texture and alpha leave of its emission
double lightPower(const gpu::Light& light, gpu::vec3 yield, const LightSurroundings& surroundings);

/// All lights with the powers and tables that follow from them.
class LightTable
{
public:
    LightTable() = default;
    /// With the pmf of `lights`, as far as aliases() are theirs. @param yields by light; empty: 1 for all
    LightTable(std::vector<gpu::Light> lights, std::vector<gpu::vec3> yields, const LightSurroundings& surroundings);
    /// A package's, as it lies there.
    explicit LightTable(const Package& package);

    std::span<const gpu::Light> lights() const { return lights_; }
    std::span<const double> powers() const { return powers_; } // by light
    std::span<const gpu::AliasEntry> aliases() const { return aliases_; }

    /// All but kind and pmf, which it keeps. Tables are old until rebuild().
    void set(uint32_t index, const gpu::Light& light);
    /// Makes pmf and aliases those of the powers: a light is picked in proportion to its power, except that directional and
    /// environment lights beside local ones get at most half of all samples. Their power is what falls on a disc as wide as
    /// the scene: indoors nearly all of that hits the roof, and the local lights that light the room would get next to none.
    /// Where no light has power, all are equally likely.
    /// @return whether a pmf has changed
    bool rebuild();

private:
    std::vector<gpu::Light> lights_;
    std::vector<gpu::vec3> yields_; // empty: all 1
    LightSurroundings surroundings_;
    std::vector<double> powers_;
    std::vector<gpu::AliasEntry> aliases_;
};
} // namespace package
