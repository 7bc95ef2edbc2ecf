#include "format/light_table.h"

#include "format/alias_table.h"
#include "format/check.h"
#include "format/vec3d.h"

#include <numbers>
#include <numeric>

namespace package
{
namespace
{
constexpr double kPi = std::numbers::pi;

bool isInfinite(const gpu::Light& light)
{
    return light.kind == gpu::kLightDirectional || light.kind == gpu::kLightEnvironment;
}

/// Solid angle of a spot's cone weighted by its falloff, which rises as a square from the rim to `width` inside it.
double spotSolidAngle(double cos_outer, double width)
{
    const double rim = std::min(width, 1 - cos_outer);
    const double full = std::max(0.0, 1 - cos_outer - width);
    return 2 * kPi * (full + rim * rim * rim / (3 * width * width));
}

/// What it emits is multiplied by this to make power.
double extent(const gpu::Light& light, const LightSurroundings& surroundings)
{
    const double disc = kPi * surroundings.radius * surroundings.radius;
    const Vec3d origin = toDouble(light.p0);
    switch (light.kind)
    {
    case gpu::kLightPoint:
        return 4 * kPi;
    case gpu::kLightSpot:
        return spotSolidAngle(-double(light.p2.y) / double(light.p2.x), 1 / double(light.p2.x));
    case gpu::kLightDirectional:
        return disc;
    case gpu::kLightEnvironment:
        return disc * 4 * kPi;
    default:
        return kPi * length(cross(toDouble(light.p1) - origin, toDouble(light.p2) - origin)) / 2 *
               (light.kind == gpu::kLightTriangleTwoSided ? 2 : 1);
    }
}

gpu::vec3 product(gpu::vec3 a, gpu::vec3 b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

/// By light.
std::vector<double> sampleShares(std::span<const gpu::Light> lights, std::span<const double> powers)
{
    constexpr double kMostInfinite = 0.5;
    const double total = std::accumulate(powers.begin(), powers.end(), 0.0);
    if (!(total > 0))
        return std::vector<double>(lights.size(), 1 / double(lights.size()));
    const auto share = [&](size_t i) { return powers[i] / total < kLeastPowerShare ? 0 : powers[i] / total; };
    double infinite = 0, local = 0;
    for (size_t i = 0; i < lights.size(); ++i)
        (isInfinite(lights[i]) ? infinite : local) += share(i);
    const bool capped = infinite > kMostInfinite && local > 0;
    std::vector<double> shares;
    shares.reserve(lights.size());
    for (size_t i = 0; i < lights.size(); ++i)
    {
        const double group = isInfinite(lights[i]) ? kMostInfinite / infinite : (1 - kMostInfinite) / local;
        shares.push_back(share(i) > 0 ? share(i) * (capped ? group : 1) : 0);
    }
    return shares;
}

LightSurroundings surroundingsOf(const lumicut::fb::Meta& meta)
{
    const auto& low = *meta.bounds_min();
    const auto& high = *meta.bounds_max();
    LightSurroundings around{.radius = sphereRadius({low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}),
                             .average_radiance = {}};
    if (const auto* environment = meta.environment())
    {
        const auto& average = *environment->average_radiance();
        around.average_radiance = {average.x(), average.y(), average.z()};
    }
    return around;
}
} // namespace

double sphereRadius(gpu::vec3 box_min, gpu::vec3 box_max)
{
    return length(toDouble(box_max) - toDouble(box_min)) / 2;
}

double lightPower(const gpu::Light& light, gpu::vec3 yield, const LightSurroundings& surroundings)
{
    constexpr double kMost = 1e280; // of which sums stay finite
    const gpu::vec3 emission =
        product(light.emission, light.kind == gpu::kLightEnvironment ? surroundings.average_radiance : yield);
    const double power = extent(light, surroundings) * double(luminance(emission));
    return power > 0 ? std::min(power, kMost) : 0; // nor NaN
}

LightTable::LightTable(std::vector<gpu::Light> lights, std::vector<gpu::vec3> yields,
                       const LightSurroundings& surroundings)
    : lights_(std::move(lights)), yields_(std::move(yields)), surroundings_(surroundings)
{
    check(yields_.empty() || yields_.size() == lights_.size(), "{} lights, {} yields", lights_.size(), yields_.size());
    for (size_t i = 0; i < lights_.size(); ++i)
        powers_.push_back(lightPower(lights_[i], yields_.empty() ? gpu::vec3{1, 1, 1} : yields_[i], surroundings_));
}

LightTable::LightTable(const Package& package)
    : LightTable({package.lights().begin(), package.lights().end()},
                 {package.lightYields().begin(), package.lightYields().end()}, surroundingsOf(package.meta()))
{
    aliases_.assign(package.lightAliases().begin(), package.lightAliases().end());
}

void LightTable::set(uint32_t index, const gpu::Light& light)
{
    check(index < lights_.size(), "light {} of {}", index, lights_.size());
    gpu::Light& mine = lights_[index];
    check(light.kind == mine.kind, "light {} is of kind {}, it cannot become one of kind {}", index, mine.kind,
          light.kind);
    const float pmf = mine.pmf;
    mine = light;
    mine.pmf = pmf;
    powers_[index] = lightPower(mine, yields_.empty() ? gpu::vec3{1, 1, 1} : yields_[index], surroundings_);
}

bool LightTable::rebuild()
{
    if (lights_.empty())
        return false;
    const std::vector<double> shares = sampleShares(lights_, powers_);
    bool changed = aliases_.size() != lights_.size();
    for (size_t i = 0; i < lights_.size(); ++i)
    {
        changed = changed || lights_[i].pmf != float(shares[i]);
        lights_[i].pmf = float(shares[i]);
    }
    if (changed)
        aliases_ = buildAliasTable(shares);
    return changed;
}
} // namespace package
