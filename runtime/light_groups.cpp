#include "runtime/light_groups.h"

#include "format/alias_table.h"

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

LightGroups groupLights(std::span<const gpu::Light> lights)
{
    LightGroups result;
    for (const LightKind kind : {LightKind::kDirectional, LightKind::kEnvironment, LightKind::kLocal})
    {
        std::vector<uint32_t> members;
        std::vector<double> weights;
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (lightKind(lights[i]) == kind && lights[i].pmf > 0)
            {
                members.push_back(i);
                weights.push_back(lights[i].pmf);
            }
        if (members.empty())
            continue;
        result.groups.push_back({.kind = kind,
                                 .first_pick = uint32_t(result.picks.size()),
                                 .pick_count = uint32_t(members.size()),
                                 .share = float(std::accumulate(weights.begin(), weights.end(), 0.0)),
                                 .one_place = members.size() == 1 && isPunctual(lights[members[0]])});
        const auto table = buildAliasTable(weights);
        for (size_t i = 0; i < members.size(); ++i)
            result.picks.push_back({members[i], table[i].threshold, members[table[i].alias]});
    }
    return result;
}
