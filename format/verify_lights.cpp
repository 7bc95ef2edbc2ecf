// Lights, the environment, and the tables they are sampled by.
#include "format/package_verify.h"

#include <vector>

namespace package
{
namespace
{
/// @param get returns entry i as {threshold, alias, probability}
/// The table must be in range and must draw every entry with the probability that the sampler divides by.
template <typename Get>
Status verifyAliasTable(const char* chunk, size_t count, const Get& get)
{
    std::vector<double> drawn(count); // in units of 1 / count
    double sum = 0;
    for (size_t i = 0; i < count; ++i)
    {
        const auto [threshold, alias, probability] = get(i);
        if (!isWithin(threshold, 0, 1))
            return invalid("chunk {}: entry {} has threshold {}, allowed is 0 to 1", chunk, i, threshold);
        if (alias >= count)
            return invalid("chunk {}: entry {} has alias {}, but there are only {} entries", chunk, i, alias, count);
        drawn[i] += threshold;
        drawn[alias] += 1.0 - threshold;
        sum += probability;
    }
    if (std::abs(sum - 1) > 1e-3)
        return invalid("chunk {}: the probabilities sum to {}, not 1", chunk, sum);
    for (size_t i = 0; i < count; ++i)
    {
        const double expected = std::get<2>(get(i)) * double(count);
        if (std::abs(drawn[i] - expected) > 1e-3 * (1 + expected) || (expected == 0 && drawn[i] > 0))
            return invalid("chunk {}: entry {} is drawn with probability {}, stated is {}", chunk, i,
                           drawn[i] / double(count), expected / double(count));
    }
    return Success{};
}

/// Which triangle it is, assignLights() has verified.
Status verifyTriangleLight(const Contents& contents, const gpu::Light& light, size_t index)
{
    if (light.material == gpu::kNone)
        return Success{};
    if (light.material >= contents.materials.size())
        return invalid("chunk LITE: light {} refers to material {}, chunk MATL has {}", index, light.material,
                       contents.materials.size());
    const gpu::Material& material = contents.materials[light.material];
    if (material.emissive_texture == gpu::kNone &&
        (material.flags & (gpu::kMaterialAlphaMask | gpu::kMaterialAlphaBlend)) == 0)
        return invalid("chunk LITE: light {} names material {}, which has neither an emissive texture nor alpha", index,
                       light.material);
    return Success{};
}

Status verifyLight(const Contents& contents, size_t index)
{
    const gpu::Light& light = contents.lights[index];
    if (light.kind > gpu::kLightEnvironment)
        return invalid("chunk LITE: light {} has the unknown kind {}", index, light.kind);
    if (!isFinite(light.p0) || !isFinite(light.p1) || !isFinite(light.p2))
        return invalid("chunk LITE: light {} has a position or direction that is not finite", index);
    if (!isNonNegative(light.emission) || !isWithin(light.pmf, 0, 1))
        return invalid("chunk LITE: light {} has an emission or probability that is negative or not finite", index);

    if (light.kind == gpu::kLightTriangle || light.kind == gpu::kLightTriangleTwoSided)
        return verifyTriangleLight(contents, light, index);
    if (light.triangle != gpu::kNone || light.material != gpu::kNone)
        return invalid("chunk LITE: light {} is no triangle but refers to one or to a material", index);
    if ((light.kind == gpu::kLightSpot || light.kind == gpu::kLightDirectional) && !isUnit(light.p1))
        return invalid("chunk LITE: light {} has a direction that is not of unit length", index);
    if (light.kind == gpu::kLightEnvironment &&
        (index + 1 != contents.lights.size() || contents.environment_map.empty()))
        return invalid("chunk LITE: light {} is an environment, which must be the last light and needs chunk ENVR",
                       index);
    return Success{};
}
} // namespace

Status verifyLights(const Contents& contents)
{
    for (size_t i = 0; i < contents.lights.size(); ++i)
    {
        if (Status light = verifyLight(contents, i); !light)
            return light;
    }
    if (contents.light_aliases.size() != contents.lights.size())
        return invalid("chunk LALS: {} entries for {} lights", contents.light_aliases.size(), contents.lights.size());
    if (!contents.light_yields.empty() && contents.light_yields.size() != contents.lights.size())
        return invalid("chunk LYLD: {} entries for {} lights", contents.light_yields.size(), contents.lights.size());
    for (size_t i = 0; i < contents.light_yields.size(); ++i)
        if (!isWithin(contents.light_yields[i], 0, 1))
            return invalid("chunk LYLD: entry {} is not within 0 and 1", i);
    if (contents.lights.empty())
        return Success{};
    return verifyAliasTable("LALS", contents.lights.size(),
                            [&](size_t i)
                            {
                                const gpu::AliasEntry& entry = contents.light_aliases[i];
                                return std::tuple(entry.threshold, entry.alias, contents.lights[i].pmf);
                            });
}

Status verifyEnvironment(const Contents& contents)
{
    const lumicut::fb::Environment* environment = contents.meta->environment();
    if (!environment)
    {
        if (!contents.environment_map.empty() || !contents.environment_texels.empty())
            return invalid("chunk ENVR or EIMP is there but META describes no environment");
        return Success{};
    }
    constexpr uint32_t kMaxSize = 16384;
    for (const uint32_t size : {environment->width(), environment->height(), environment->importance_width(),
                                environment->importance_height()})
    {
        if (size < 1 || size > kMaxSize)
            return invalid("chunk META: the environment has a side of {} texels, allowed are 1 to {}", size, kMaxSize);
    }
    const lumicut::fb::Vec3* average = environment->average_radiance();
    if (!average || !isNonNegative({average->x(), average->y(), average->z()}))
        return invalid("chunk META: the environment's average radiance is missing, negative or not finite");
    constexpr float kHalfTurn = 3.1415928f; // radians: pi, rounded up
    if (!isWithin(environment->rotation(), -kHalfTurn, kHalfTurn))
        return invalid("chunk META: the environment is turned by {} radians, allowed is -pi to pi",
                       environment->rotation());
    if (contents.environment_map.size() != size_t(environment->width()) * environment->height())
        return invalid("chunk ENVR: {} texels, META says {} x {}", contents.environment_map.size(),
                       environment->width(), environment->height());
    if (contents.environment_texels.size() !=
        size_t(environment->importance_width()) * environment->importance_height())
        return invalid("chunk EIMP: {} texels, META says {} x {}", contents.environment_texels.size(),
                       environment->importance_width(), environment->importance_height());
    for (size_t i = 0; i < contents.environment_map.size(); ++i)
    {
        const gpu::vec4& texel = contents.environment_map[i];
        if (!isNonNegative({texel.x, texel.y, texel.z}) || !std::isfinite(texel.w))
            return invalid("chunk ENVR: texel {} is negative or not finite", i);
    }
    for (size_t i = 0; i < contents.environment_texels.size(); ++i)
    {
        if (!isWithin(contents.environment_texels[i].probability, 0, 1))
            return invalid("chunk EIMP: texel {} has probability {}, allowed is 0 to 1", i,
                           contents.environment_texels[i].probability);
    }
    return verifyAliasTable("EIMP", contents.environment_texels.size(),
                            [&](size_t i)
                            {
                                const gpu::EnvironmentTexel& texel = contents.environment_texels[i];
                                return std::tuple(texel.threshold, texel.alias, texel.probability);
                            });
}
} // namespace package
