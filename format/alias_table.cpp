#include "format/alias_table.h"

#include "format/check.h"

#include <algorithm>
#include <numeric>

std::vector<gpu::AliasEntry> buildAliasTable(std::span<const double> weights)
{
    const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    check(total > 0, "total weight {}", total);

    std::vector<double> scaled; // 1 is the mean weight
    std::vector<uint32_t> small;
    std::vector<uint32_t> large;
    for (uint32_t i = 0; i < weights.size(); ++i)
    {
        scaled.push_back(weights[i] / total * double(weights.size()));
        (scaled[i] < 1 ? small : large).push_back(i);
    }

    std::vector<gpu::AliasEntry> table(weights.size());
    while (!small.empty() && !large.empty())
    {
        const uint32_t poor = small.back();
        const uint32_t rich = large.back();
        small.pop_back();
        table[poor] = {float(scaled[poor]), rich};
        scaled[rich] -= 1 - scaled[poor];
        if (scaled[rich] < 1)
        {
            large.pop_back();
            small.push_back(rich);
        }
    }
    // The rest differs from the mean weight by rounding only, but for weights of 0 for which rounding has left nothing rich.
    const auto largest = uint32_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
    for (const std::vector<uint32_t>* rest : {&small, &large})
    {
        for (const uint32_t i : *rest)
            table[i] = weights[i] > 0 ? gpu::AliasEntry{1.0f, i} : gpu::AliasEntry{0.0f, largest};
    }
    return table;
}
