#include "runtime/gpu/schedule.h"

#include <algorithm>

uint32_t Schedule::place(std::span<const Access> accesses, uint32_t earliest)
{
    uint32_t step = earliest;
    for (const Access& access : accesses)
        for (const Used& used : used_[access.range.memory])
            if (used.range.overlaps(access.range))
            {
                if (access.reads || access.writes)
                    step = std::max(step, used.after_writes);
                if (access.writes)
                    step = std::max(step, used.after_reads);
            }
    for (const Access& access : accesses)
    {
        std::vector<Used>& ranges = used_[access.range.memory];
        auto used = std::ranges::find(ranges, access.range, &Used::range);
        if (used == ranges.end())
            used = ranges.insert(ranges.end(), Used{.range = access.range});
        if (access.reads)
            used->after_reads = std::max(used->after_reads, step + 1);
        if (access.writes)
            used->after_writes = std::max(used->after_writes, step + 1);
    }
    return step;
}
