// Steps of commands, against every pair of them.
#include "runtime/gpu/schedule.h"

#include <gtest/gtest.h>
#include <random>

namespace
{
/// Addresses of memory that is never looked into.
const Memory* memory(size_t i)
{
    static std::byte places[4];
    return reinterpret_cast<const Memory*>(&places[i]);
}

bool mustWait(const std::vector<Access>& before, const std::vector<Access>& after)
{
    for (const Access& a : before)
        for (const Access& b : after)
            if (a.range.overlaps(b.range) && ((a.writes && (b.reads || b.writes)) || (b.writes && a.reads)))
                return true;
    return false;
}

TEST(Schedule, PutsEachCommandRightAfterTheLastThatItMustWaitFor)
{
    std::mt19937 random(5);
    const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
    uint32_t last = 0;
    for (uint32_t round = 0; round < 20; ++round)
    {
        Schedule schedule;
        std::vector<std::vector<Access>> commands;
        std::vector<uint32_t> steps;
        for (uint32_t i = 0; i < 60; ++i)
        {
            std::vector<Access> accesses;
            for (uint32_t k = below(4); k < 4; ++k)
            {
                const uint64_t begin = below(50);
                const bool reads = below(3) > 0;
                accesses.push_back({.range = {.memory = memory(below(4)), .begin = begin, .end = begin + 1 + below(10)},
                                    .reads = reads,
                                    .writes = !reads || below(4) == 0});
            }
            uint32_t want = i == 40 ? 7u : 0u; // asked for
            for (size_t before = 0; before < commands.size(); ++before)
                if (mustWait(commands[before], accesses))
                    want = std::max(want, steps[before] + 1);
            const uint32_t step = schedule.place(accesses, i == 40 ? 7u : 0u);
            ASSERT_EQ(step, want) << "command " << i;
            commands.push_back(accesses);
            steps.push_back(step);
            last = std::max(last, step);
        }
    }
    EXPECT_GT(last, 3u); // some did wait
}
} // namespace
