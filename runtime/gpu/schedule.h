// When each command of a submission may run.
#pragma once
#include "runtime/gpu/memory.h"

#include <span>
#include <unordered_map>
#include <vector>

struct Access
{
    MemoryRange range;
    bool reads, writes;
};

/// Puts commands into steps. Those of one step may run side by side; all of a step end before the next one begins. Nothing but memory
/// orders commands: one that reads comes after those before it that wrote there, and one that writes also after those that read.
class Schedule
{
public:
    void restart() { used_.clear(); }
    /// @return the first step from `earliest` on in which a command may run that comes after all those placed before
    uint32_t place(std::span<const Access> accesses, uint32_t earliest = 0);

private:
    struct Used
    {
        MemoryRange range;
        uint32_t after_reads = 0, after_writes = 0; // the first step after all that read and that wrote there
    };
    std::unordered_map<const Memory*, std::vector<Used>> used_;
};
