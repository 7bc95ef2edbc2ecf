#include "runtime/gpu/scratch.h"

#include <algorithm>

Scratch Scratch::part() const
{
    Scratch scratch;
    if (stage_)
        scratch.stage_ = std::make_shared<Stage>(*stage_);
    return scratch;
}

Scratch::Place Scratch::place(const VkMemoryRequirements& needs,
                              const std::function<std::shared_ptr<Memory>(uint64_t bytes)>& allocate) const
{
    Blocks& blocks = *stage_->blocks;
    std::vector<uint64_t>& used = stage_->used;
    for (size_t i = 0;; ++i)
    {
        if (i == blocks.size())
        {
            auto block = allocate(blocks.empty() ? std::max(needs.size, stage_->first_block) : needs.size);
            if (!block)
                return {};
            blocks.push_back(std::move(block));
        }
        used.resize(blocks.size());
        const uint64_t offset = (used[i] + needs.alignment - 1) / needs.alignment * needs.alignment;
        if (offset + needs.size > blocks[i]->size())
            continue;
        used[i] = offset + needs.size;
        return {.memory = blocks[i], .offset = offset};
    }
}
