#include "runtime/light_groups.h"

#include "format/alias_table.h"

#include <map>
#include <numeric>

namespace
{
LightKind kindOf(const LightProbability& light)
{
    return !light.isInfinite()  ? LightKind::kLocal
           : light.isPunctual() ? LightKind::kDirectional
                                : LightKind::kEnvironment;
}

void addCluster(LightGroups& result, std::span<const LightProbability> lights, const std::vector<uint32_t>& members)
{
    std::vector<double> weights;
    for (const uint32_t light : members)
        weights.push_back(lights[light].pmf);
    const double share = std::accumulate(weights.begin(), weights.end(), 0.0);
    result.clusters.push_back(
        {.first_pick = uint32_t(result.picks.size()), .pick_count = uint32_t(members.size()), .share = float(share)});
    const auto table = buildAliasTable(weights);
    for (size_t i = 0; i < members.size(); ++i)
    {
        result.picks.push_back({members[i], table[i].threshold, members[table[i].alias]});
        result.densities[members[i]] = float(1 / share);
    }
}
} // namespace

LightGroups groupLights(std::span<const LightProbability> lights)
{
    LightGroups result{.groups = {}, .clusters = {}, .picks = {}, .densities = std::vector<float>(lights.size())};
    for (const LightKind kind : {LightKind::kDirectional, LightKind::kEnvironment, LightKind::kLocal})
    {
        std::map<uint32_t, std::vector<uint32_t>> clusters;
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (kindOf(lights[i]) == kind && lights[i].pmf > 0)
                clusters[lights[i].cluster].push_back(i);
        if (clusters.empty())
            continue;
        const std::vector<uint32_t>& first = clusters.begin()->second;
        result.groups.push_back(
            {.kind = kind,
             .first_cluster = uint32_t(result.clusters.size()),
             .cluster_count = uint32_t(clusters.size()),
             .one_place = clusters.size() == 1 && first.size() == 1 && lights[first[0]].isPunctual()});
        for (const auto& [number, members] : clusters)
            addCluster(result, lights, members);
    }
    return result;
}
