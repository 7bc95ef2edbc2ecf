#include "runtime/stages/primitives.h"

#include <algorithm>
#include <array>

namespace
{
uint32_t dividedUp(uint32_t count, uint32_t by)
{
    return count / by + (count % by > 0);
}

gpu::ScanParams scanParams(uint32_t max_count, Workers workers)
{
    const uint32_t least = workers == Workers::kThreads ? gpu::kLongScanTile : gpu::kScanTile;
    return {.max_count = max_count,
            .group_count = std::clamp(dividedUp(max_count, least), 1u, gpu::kMaxScanGroups),
            .least_share = least};
}

/// Threads that take shares of their own need not meet more than once.
Constant scanConstant(Workers workers)
{
    return {"kItems", workers == Workers::kThreads ? 0 : gpu::kScanItems};
}

uint32_t sortWorkerCount(uint32_t max_count, Workers workers)
{
    if (workers == Workers::kGroups)
        return std::clamp(dividedUp(max_count, gpu::kSortTile), 1u, gpu::kMaxSortGroups);
    return gpu::kLanes * std::clamp(dividedUp(max_count, gpu::kLanes * gpu::kLaneLeast), 1u, gpu::kMaxLaneGroups);
}

/// How many values a level of a segmented reduction hands to the next.
uint32_t reducedCount(uint32_t count)
{
    return 2 * dividedUp(count, gpu::kReduceItems);
}

const char* reduceKernel(SegmentedReduction::Type type)
{
    switch (type)
    {
    case SegmentedReduction::Type::kUint:
        return "primitives/reduce_uint";
    case SegmentedReduction::Type::kFloat:
        return "primitives/reduce_float";
    case SegmentedReduction::Type::kVec4:
        return "primitives/reduce_vec4";
    }
    return "";
}

/// Leaves out what only later groups read where there are none.
void recordSums(Recorder& rec, const Kernel& sum, const gpu::ScanParams& params, const Buffer& values,
                const Buffer& group_sums, const Buffer& size)
{
    if (params.group_count > 1)
        rec.run(sum, params.group_count * gpu::kPrimitivesGroupSize, params,
                {{"Size", size}, {"Values", values}, {"GroupSums", group_sums}});
}
} // namespace

Workers fastestWorkers(const Device& device)
{
    return device.isCpu() ? Workers::kThreads : Workers::kGroups;
}

RadixSort::RadixSort(const Device& device, std::string_view name, uint32_t max_count, uint32_t key_words,
                     std::optional<Workers> workers, const Scratch& scratch)
    : max_count_(max_count), key_words_(key_words), workers_(workers.value_or(fastestWorkers(device))),
      worker_count_(sortWorkerCount(max_count, workers_)),
      in_one_group_(workers_ == Workers::kGroups && max_count <= gpu::kSmallSort)
{
    check(key_words == 1 || key_words == 2, "{}: keys of {} words", name, key_words);
    const Constant words{"kKeyWords", key_words};
    if (in_one_group_)
    {
        small_ = device.kernel("primitives/sort_small", {words});
        return;
    }
    const std::string kind = workers_ == Workers::kGroups ? "primitives/sort_" : "primitives/lane_";
    count_ = device.kernel(kind + "count", {words});
    offsets_ = device.kernel(kind + "offsets");
    move_ = device.kernel(kind + "move", {words});
    keys_ = device.array<uint32_t>(fmt::format("{}.keys", name), uint64_t(max_count) * key_words, scratch);
    values_ = device.array<uint32_t>(fmt::format("{}.values", name), max_count, scratch);
    counts_ =
        device.array<uint32_t>(fmt::format("{}.counts", name), uint64_t(worker_count_) * gpu::kMaxDigits, scratch);
    totals_ = device.array<uint32_t>(fmt::format("{}.totals", name), gpu::kMaxDigits);
}

uint64_t RadixSort::scratchBytes(uint32_t max_count, uint32_t key_words, Workers workers)
{
    return (uint64_t(max_count) * (key_words + 1) + uint64_t(sortWorkerCount(max_count, workers)) * gpu::kMaxDigits) *
           sizeof(uint32_t);
}

void RadixSort::record(Recorder& rec, const Buffer& keys, const Buffer& values, const Buffer& size,
                       uint32_t key_bits) const
{
    check(key_bits >= 1 && key_bits <= 32 * key_words_, "{}: {} bits of keys of {} words", keys.name(), key_bits,
          key_words_);
    if (in_one_group_)
    {
        rec.run(small_, 1, gpu::SmallSortParams{.max_count = max_count_, .key_bits = key_bits},
                {{"Size", size}, {"Keys", keys}, {"Values", values}});
        return;
    }
    // An even number of passes, so that the last one ends in the caller's buffers.
    const uint32_t pass_count = 2 * dividedUp(key_bits, 2 * gpu::kMaxDigitBits);
    const uint32_t digit_bits = dividedUp(key_bits, pass_count);
    const Pairs given{keys, values}, scratch{keys_, values_};
    for (uint32_t pass = 0; pass < pass_count; ++pass)
    {
        const uint32_t first_bit = std::min(pass * digit_bits, key_bits);
        recordPass(rec, pass % 2 == 0 ? given : scratch, pass % 2 == 0 ? scratch : given, size,
                   {.max_count = max_count_,
                    .first_bit = first_bit,
                    .digit_bits = std::min(digit_bits, key_bits - first_bit),
                    .worker_count = worker_count_});
    }
}

void RadixSort::recordPass(Recorder& rec, const Pairs& from, const Pairs& to, const Buffer& size,
                           const gpu::SortParams& params) const
{
    const bool groups = workers_ == Workers::kGroups;
    const uint32_t threads = worker_count_ * (groups ? gpu::kPrimitivesGroupSize : 1);
    rec.run(count_, threads, params, {{"Size", size}, {"Keys", from.keys}, {"Counts", counts_}});
    if (groups)
    {
        rec.run(offsets_, gpu::kPrimitivesGroupSize << params.digit_bits, params,
                {{"Size", size}, {"Counts", counts_}, {"Totals", totals_}});
        rec.run(move_, threads, params,
                {{"Size", size},
                 {"Keys", from.keys},
                 {"Values", from.values},
                 {"Offsets", counts_},
                 {"Totals", totals_},
                 {"MovedKeys", to.keys},
                 {"MovedValues", to.values}});
        return;
    }
    rec.run(offsets_, 1, params, {{"Size", size}, {"Counts", counts_}});
    rec.run(move_, threads, params,
            {{"Size", size},
             {"Keys", from.keys},
             {"Values", from.values},
             {"Offsets", counts_},
             {"MovedKeys", to.keys},
             {"MovedValues", to.values}});
}

Scan::Scan(const Device& device, std::string_view name, uint32_t max_count, std::optional<Workers> workers)
    : params_(scanParams(max_count, workers.value_or(fastestWorkers(device)))), sum_(device.kernel("primitives/sum")),
      scan_(device.kernel("primitives/scan", {scanConstant(workers.value_or(fastestWorkers(device)))})),
      group_sums_(device.array<uint32_t>(fmt::format("{}.group_sums", name), params_.group_count))
{
}

void Scan::record(Recorder& rec, const Buffer& values, const Buffer& sums, const Buffer& total,
                  const Buffer& size) const
{
    recordSums(rec, sum_, params_, values, group_sums_, size);
    rec.run(scan_, params_.group_count * gpu::kPrimitivesGroupSize, params_,
            {{"Size", size}, {"Values", values}, {"GroupSums", group_sums_}, {"Sums", sums}, {"Total", total}});
}

Compaction::Compaction(const Device& device, std::string_view name, uint32_t max_count, std::optional<Workers> workers)
    : params_(scanParams(max_count, workers.value_or(fastestWorkers(device)))),
      sum_(device.kernel("primitives/sum", {{"kFlags", 1}})),
      compact_(device.kernel("primitives/compact", {scanConstant(workers.value_or(fastestWorkers(device)))})),
      group_sums_(device.array<uint32_t>(fmt::format("{}.group_sums", name), params_.group_count))
{
}

void Compaction::record(Recorder& rec, const Buffer& flags, const Buffer& indices, const Buffer& selected,
                        const Buffer& size) const
{
    recordSums(rec, sum_, params_, flags, group_sums_, size);
    rec.run(
        compact_, params_.group_count * gpu::kPrimitivesGroupSize, params_,
        {{"Size", size}, {"Flags", flags}, {"GroupSums", group_sums_}, {"Indices", indices}, {"Selected", selected}});
}

SegmentedReduction::SegmentedReduction(const Device& device, std::string_view name, uint32_t max_count, Type type)
    : max_count_(max_count), reduce_(device.kernel(reduceKernel(type)))
{
    uint64_t count = max_count;
    for (Level& level : levels_)
    {
        count = reducedCount(uint32_t(count));
        level.segments = device.array<uint32_t>(fmt::format("{}.segments", name), count);
        level.values = device.array<uint32_t>(fmt::format("{}.values", name), count * (type == Type::kVec4 ? 4 : 1));
    }
}

void SegmentedReduction::record(Recorder& rec, const Buffer& values, const Buffer& segments, const Buffer& results,
                                const Buffer& size, uint32_t segment_count) const
{
    rec.clear(results);
    const Buffer* from_segments = &segments;
    const Buffer* from_values = &values;
    uint32_t count = max_count_;
    for (uint32_t level = 0;; ++level)
    {
        const bool is_last = count <= gpu::kReduceItems;
        const Level& next = levels_[level % 2];
        rec.run(reduce_, dividedUp(count, gpu::kReduceItems),
                gpu::ReduceParams{.max_count = max_count_,
                                  .segment_count = segment_count,
                                  .level = level,
                                  .is_last_level = is_last ? 1u : 0u},
                {{"Size", size},
                 {"Segments", *from_segments},
                 {"Values", *from_values},
                 {"NextSegments", next.segments},
                 {"NextValues", next.values},
                 {"Results", results}});
        if (is_last)
            return;
        from_segments = &next.segments;
        from_values = &next.values;
        count = reducedCount(count);
    }
}
