// Device memory that stages use one after the other, for what each of them needs only while it runs.
#pragma once
#include "runtime/gpu/memory.h"

#include <functional>
#include <vector>

class Device;

/// Memory from a ScratchPool for the buffers of one stage, which do not overlap each other. Copies stand for the same stage.
/// What its buffers hold is lost when another stage of the pool runs. The recorder orders stages as their buffers overlap.
class Scratch
{
public:
    /// No pool: every buffer has memory of its own.
    Scratch() = default;

    /// For a part of the stage that goes on from here and shares its memory with the other parts that do: they run one after the
    /// other. What is allocated from this scratch later may lie there, too.
    Scratch part() const;

private:
    friend class ScratchPool;
    friend class Device;
    using Blocks = std::vector<std::shared_ptr<Memory>>;
    struct Place
    {
        std::shared_ptr<Memory> memory;
        uint64_t offset;
    };
    struct Stage
    {
        std::shared_ptr<Blocks> blocks; // the pool's
        uint64_t first_block;           // bytes that the pool's first block has at least
        std::vector<uint64_t> used;     // bytes of each block
    };
    /// @param allocate makes a new block of so many bytes; @return none where that fails
    Place place(const VkMemoryRequirements& needs,
                const std::function<std::shared_ptr<Memory>(uint64_t bytes)>& allocate) const;

    std::shared_ptr<Stage> stage_;
};

class ScratchPool
{
public:
    /// @param most_bytes what the largest stage needs, if known: then no other block of memory is made
    explicit ScratchPool(uint64_t most_bytes = 0)
        : most_bytes_(most_bytes), blocks_(std::make_shared<Scratch::Blocks>())
    {
    }

    /// All of the pool's memory, for a stage that runs when no other one does.
    Scratch stage() const
    {
        Scratch scratch;
        scratch.stage_ =
            std::make_shared<Scratch::Stage>(Scratch::Stage{.blocks = blocks_, .first_block = most_bytes_, .used = {}});
        return scratch;
    }

private:
    uint64_t most_bytes_;
    std::shared_ptr<Scratch::Blocks> blocks_;
};
