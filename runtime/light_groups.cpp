#include "runtime/light_groups.h"

#include "format/alias_table.h"

#include <algorithm>
#include <map>
#include <numeric>

LightKind lightKind(const gpu::Light& light)
{
    return light.kind == gpu::kLightDirectional   ? LightKind::kDirectional
           : light.kind == gpu::kLightEnvironment ? LightKind::kEnvironment
                                                  : LightKind::kLocal;
}

bool isPunctual(const gpu::Light& light)
{
    return light.kind < gpu::kLightTriangle;
}

namespace
{
void addCluster(LightGroups& result, std::span<const gpu::Light> lights, const std::vector<uint32_t>& members)
{
    std::vector<double> weights;
    for (const uint32_t light : members)
        weights.push_back(lights[light].pmf);
    const double share = std::accumulate(weights.begin(), weights.end(), 0.0);
    result.clusters.push_back({.first_pick = uint32_t(result.picks.size()),
                               .pick_count = uint32_t(members.size()),
                               .share = float(share),
                               .strongest = members[size_t(std::ranges::max_element(weights) - weights.begin())]});
    const auto table = buildAliasTable(weights);
    for (size_t i = 0; i < members.size(); ++i)
    {
        result.picks.push_back({members[i], table[i].threshold, members[table[i].alias], 0});
        result.densities[members[i]] = float(1 / share);
    }
}
} // namespace

LightGroups groupLights(std::span<const gpu::Light> lights, std::span<const uint32_t> clusters_of)
{
    LightGroups result{.groups = {}, .clusters = {}, .picks = {}, .densities = std::vector<float>(lights.size())};
    for (const LightKind kind : {LightKind::kDirectional, LightKind::kEnvironment, LightKind::kLocal})
    {
        std::map<uint32_t, std::vector<uint32_t>> clusters;
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (lightKind(lights[i]) == kind && lights[i].pmf > 0)
                clusters[kind == LightKind::kLocal ? clusters_of[i] : 0].push_back(i);
        if (clusters.empty())
            continue;
        const bool punctual =
            std::ranges::all_of(clusters, [&](const auto& entry)
                                { return entry.second.size() == 1 && isPunctual(lights[entry.second[0]]); });
        uint32_t extended = 0, bit = 1;
        for (const auto& [number, members] : clusters)
        {
            if (!std::ranges::all_of(members, [&](uint32_t i) { return isPunctual(lights[i]); }))
                extended |= bit;
            bit <<= 1;
        }
        result.groups.push_back({.kind = kind,
                                 .first_cluster = uint32_t(result.clusters.size()),
                                 .cluster_count = uint32_t(clusters.size()),
                                 .punctual = punctual,
                                 .one_place = punctual && clusters.size() == 1,
                                 .extended = extended});
        for (const auto& [number, members] : clusters)
            addCluster(result, lights, members);
    }
    return result;
}
