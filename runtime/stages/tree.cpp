#include "runtime/stages/tree.h"

Constant climbConstant(const Device& device)
{
    return {"kFences", device.isCpu() ? 0u : 1u};
}

Tree::Tree(const Device& device, std::string_view name, uint32_t max_count, const Scratch& scratch)
    : keys_kernel_(device.kernel("tree/keys")), hierarchy_(device.kernel("tree/hierarchy")),
      bounds_(device.kernel("tree/bounds", {climbConstant(device)})),
      sort_(device, fmt::format("{}.sort", name), max_count, 1, {}, scratch),
      keys_(device.array<uint32_t>(fmt::format("{}.keys", name), max_count, scratch)),
      order_(device.array<uint32_t>(fmt::format("{}.order", name), max_count)),
      nodes_(device.texelArray<gpu::TreeNode>(fmt::format("{}.nodes", name), max_count)),
      leaf_parents_(device.array<uint32_t>(fmt::format("{}.leaf_parents", name), max_count)),
      node_parents_(device.array<uint32_t>(fmt::format("{}.node_parents", name), max_count)),
      arrivals_(device.array<uint32_t>(fmt::format("{}.arrivals", name), max_count, scratch))
{
}

uint64_t Tree::scratchBytes(const Device& device, uint32_t max_count)
{
    return RadixSort::scratchBytes(max_count, 1, fastestWorkers(device)) + 2 * max_count * sizeof(uint32_t);
}

void Tree::record(Recorder& rec, const Buffer& spheres, const Buffer& size) const
{
    rec.runIndirect(keys_kernel_, size, NoParams{},
                    {{"Size", size}, {"Spheres", spheres}, {"Keys", keys_}, {"Order", order_}});
    recordKeyed(rec, spheres, size, gpu::kTreeKeyBits);
}

void Tree::recordKeyed(Recorder& rec, const Buffer& spheres, const Buffer& size, uint32_t key_bits) const
{
    sort_.record(rec, keys_, order_, size, key_bits);
    rec.runIndirect(hierarchy_, size, NoParams{},
                    {{"Size", size},
                     {"Keys", keys_},
                     {"Nodes", nodes_},
                     {"LeafParents", leaf_parents_},
                     {"NodeParents", node_parents_}});
    refit(rec, spheres, size);
}

void Tree::refit(Recorder& rec, const Buffer& spheres, const Buffer& size) const
{
    rec.clear(arrivals_);
    rec.runIndirect(bounds_, size, NoParams{},
                    {{"Size", size},
                     {"Spheres", spheres},
                     {"Order", order_},
                     {"LeafParents", leaf_parents_},
                     {"NodeParents", node_parents_},
                     {"Nodes", nodes_},
                     {"Arrivals", arrivals_}});
}
