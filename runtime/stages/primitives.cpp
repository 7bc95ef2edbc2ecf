#include "runtime/stages/primitives.h"

#include <algorithm>
#include <array>

namespace
{
constexpr std::array kFlags{1u}; // of primitives/sum

uint32_t dividedUp(uint32_t count, uint32_t by)
{
    return count / by + (count % by > 0);
}

gpu::ScanParams scanParams(uint32_t max_count)
{
    const uint32_t tiles = std::max(dividedUp(max_count, gpu::kScanTile), 1u);
    return {.max_count = max_count, .group_count = std::min(tiles, gpu::kMaxTileGroups)};
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

SortWorkers sortWorkersOf(const Device& device)
{
    return device.isCpu() ? SortWorkers::kThreads : SortWorkers::kGroups;
}

RadixSort::RadixSort(const Device& device, std::string_view name, uint32_t max_count, uint32_t key_words)
    : RadixSort(device, name, max_count, key_words, sortWorkersOf(device))
{
}

RadixSort::RadixSort(const Device& device, std::string_view name, uint32_t max_count, uint32_t key_words, SortWorkers)
    : max_count_(max_count), key_words_(key_words),
      worker_count_(gpu::kLanes *
                    std::clamp(dividedUp(max_count, gpu::kLanes * gpu::kLaneLeast), 1u, gpu::kMaxLaneGroups)),
      count_(device.kernel("primitives/lane_count", std::array{key_words})),
      offsets_(device.kernel("primitives/lane_offsets")),
      move_(device.kernel("primitives/lane_move", std::array{key_words})),
      keys_(device.array<uint32_t>(fmt::format("{}.keys", name), uint64_t(max_count) * key_words)),
      values_(device.array<uint32_t>(fmt::format("{}.values", name), max_count)),
      counts_(device.array<uint32_t>(fmt::format("{}.counts", name), uint64_t(worker_count_) * gpu::kMaxDigits))
{
    check(key_words == 1 || key_words == 2, "{}: keys of {} words", name, key_words);
}

void RadixSort::record(Recorder& rec, const Buffer& keys, const Buffer& values, const Buffer& size,
                       uint32_t key_bits) const
{
    check(key_bits >= 1 && key_bits <= 32 * key_words_, "{}: {} bits of keys of {} words", keys_.name(), key_bits,
          key_words_);
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
    rec.run(count_, worker_count_, params, {{"Size", size}, {"Keys", from.keys}, {"Counts", counts_}});
    rec.run(offsets_, 1, params, {{"Size", size}, {"Counts", counts_}});
    rec.run(move_, worker_count_, params,
            {{"Size", size}, {"Keys", from.keys}, {"Values", from.values}, {"Offsets", counts_},
             {"MovedKeys", to.keys}, {"MovedValues", to.values}});
}

Scan::Scan(const Device& device, std::string_view name, uint32_t max_count)
    : params_(scanParams(max_count)), sum_(device.kernel("primitives/sum")), scan_(device.kernel("primitives/scan")),
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

Compaction::Compaction(const Device& device, std::string_view name, uint32_t max_count)
    : params_(scanParams(max_count)), sum_(device.kernel("primitives/sum", kFlags)),
      compact_(device.kernel("primitives/compact")),
      group_sums_(device.array<uint32_t>(fmt::format("{}.group_sums", name), params_.group_count))
{
}

void Compaction::record(Recorder& rec, const Buffer& flags, const Buffer& indices, const Buffer& selected,
                        const Buffer& size) const
{
    recordSums(rec, sum_, params_, flags, group_sums_, size);
    rec.run(compact_, params_.group_count * gpu::kPrimitivesGroupSize, params_,
            {{"Size", size}, {"Flags", flags}, {"GroupSums", group_sums_}, {"Indices", indices},
             {"Selected", selected}});
}
