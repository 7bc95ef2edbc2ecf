// Scenes of lights, and what their samplers draw on the device.
#pragma once
#include "tests/stages/sampling_test.h"

#include <cmath>
#include <optional>

inline constexpr double kSqrtHalf = std::numbers::sqrt2 / 2;
/// Of densities and powers: a few roundings of squares of distances and cosines.
inline constexpr double kRounding = 1e-4;

/// A lamp of kWidth x kDepth metres that hangs kHeight over the origin and faces down.
inline constexpr double kWidth = 0.8, kDepth = 0.5, kHeight = 2.5, kRadiance = 5;
inline void addLamp(SceneBuilder& builder, const nlohmann::json& material)
{
    builder.quad({-0.4f, 2.5f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(material));
}

class LightSampling : public Sampling
{
protected:
    /// A floor of 4 x 4 metres and whatever else `build` adds.
    template <typename Build>
    void open(const Build& build)
    {
        builder_ = std::make_unique<SceneBuilder>();
        builder_->floor(4, 0, builder_->material(lambert(0.5)));
        build(*builder_);
        const std::filesystem::path file = builder_->compile();
        scene_ = load(file);
        auto package = package::Package::open(file);
        check(bool(package), "{}", package ? "" : package.error().message);
        package_.emplace(std::move(*package));
    }

    std::vector<gpu::LightDraw> lit(gpu::vec3 point)
    {
        return draw<gpu::LightDraw>(testKernel("draw/light", scene_->constants()), *scene_,
                                    gpu::DrawParams{.count = kDraws, .seed = ++seed_, .aim = 0, .point = point});
    }
    std::vector<gpu::PhotonStart> emitted(float aim = 0)
    {
        return draw<gpu::PhotonStart>(testKernel("draw/emission", scene_->constants()), *scene_,
                                      gpu::DrawParams{.count = kDraws, .seed = ++seed_, .aim = aim, .point = {}});
    }
    static bool leaves(const gpu::PhotonStart& start) { return start.power.x > 0; }

    /// Directions of what leaves against their density per steradian.
    ChiSquared directions(const std::vector<gpu::PhotonStart>& starts, const SphereGrid& grid,
                          const std::function<double(Double3)>& density)
    {
        std::vector<double> counts(grid.cellCount());
        for (const gpu::PhotonStart& start : starts)
            ++counts[leaves(start) ? grid.cellOf(start.direction) : grid.absorbedCell()];
        return chiSquared(counts, times(kDraws, grid.integrate(density)));
    }

    /// Two mirrors, at which photons are aimed.
    static void addMirrors(SceneBuilder& builder)
    {
        const int metal = builder.material({{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
        builder.sphere({0.9f, 0.5f, 0.4f}, 0.4f, 6, true, metal);
        builder.sphere({-0.9f, 0.3f, -0.2f}, 0.25f, 6, true, metal);
    }
    /// 1 - cos of the half angle under which a target is seen.
    static double coneHeight(const gpu::CausticTarget& t, Double3 from)
    {
        return 1 - std::sqrt(1 - double(t.radius) * t.radius / length2(Double3(t.center) - from));
    }
    double aimedDensity(Double3 from, Double3 direction) const
    {
        double sum = 0;
        for (const gpu::CausticTarget& t : package_->causticTargets())
        {
            const double height = coneHeight(t, from);
            if (1 - dot(direction, normalized(Double3(t.center) - from)) <= height)
                sum += 1 / (2 * kPi * height);
        }
        return sum / double(package_->causticTargets().size());
    }

    Double3 sceneCenter() const
    {
        return 0.5 * (Double3(scene_->info().bounds_min) + Double3(scene_->info().bounds_max));
    }
    double sceneRadius() const
    {
        return 0.5 * length(Double3(scene_->info().bounds_max) - Double3(scene_->info().bounds_min)) * 1.0001;
    }
    /// Rings of equal area times slices of a disc about `center`, seen along `axis`; its last cell is all the rest.
    static size_t discCell(Double3 at, Double3 center, Double3 axis, double radius, size_t rings, size_t slices)
    {
        const Double3 side = normalized(cross(axis, std::abs(axis.x) < 0.9 ? Double3(1, 0, 0) : Double3(0, 1, 0)));
        const Double3 d = at - center;
        const double x = dot(d, side), y = dot(d, cross(axis, side)), r2 = (x * x + y * y) / (radius * radius);
        if (r2 >= 1)
            return rings * slices;
        const double slice = std::atan2(y, x) / (2 * kPi) + 0.5;
        return size_t(r2 * double(rings)) * slices + std::min(size_t(slice * double(slices)), slices - 1);
    }

    std::unique_ptr<SceneBuilder> builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<package::Package> package_;
    uint32_t seed_ = 100;
};

/// The ring width with which a cone ends between the 8th and the 9th of 12 rings: nothing jumps within a cell.
inline double widthFor(double cone_height)
{
    return 8 * cone_height / (16 - 12 * cone_height);
}

inline ImageF patternedMap()
{
    ImageF map{.width = 16, .height = 8, .rgb = {}};
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 16; ++x)
            map.rgb.insert(map.rgb.end(), {0.3f + 0.1f * float(y), y == 2 ? 3 : 0.5f, x == 5 && y == 2 ? 9 : 0.4f});
    return map;
}

inline nlohmann::json turned(double x, double y, double z) // quarter turns and less of what points to -z
{
    return {{"translation", {x, y, z}}, {"rotation", {-kSqrtHalf, 0, 0, kSqrtHalf}}};
}
