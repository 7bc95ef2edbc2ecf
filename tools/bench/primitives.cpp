#include "tools/bench/primitives.h"

#include "runtime/stages/primitives.h"

#include <algorithm>
#include <array>
#include <random>

namespace
{
constexpr std::array kKinds{"sort 30 bits", "sort 32 bits", "sort 64 bits",
                            "scan",         "compaction",   "segmented reduction"};
constexpr std::array kKeys{"sort_30", "sort_32", "sort_64", "scan", "compaction", "segmented_reduction"};
static_assert(kKinds.size() == kKeys.size());

struct Row
{
    uint32_t items;
    std::array<std::vector<double>, kKinds.size()> ms;

    double median(size_t kind) const
    {
        std::vector<double> sorted = ms[kind];
        std::ranges::sort(sorted);
        return sorted[sorted.size() / 2];
    }
    double gigaitemsPerSecond(size_t kind) const { return items / median(kind) * 1e-6; }
};

Row measure(const Device& device, uint32_t count, Workers workers, uint32_t repeats)
{
    std::mt19937 engine(1);
    std::vector<uint32_t> random(uint64_t(count) * 2);
    std::ranges::generate(random, engine);
    std::vector<uint32_t> coin(count); // flags
    std::ranges::transform(random.begin(), random.begin() + count, coin.begin(), [](uint32_t r) { return r & 1; });
    const gpu::QueueSize all{.count = count, .groups = {}};
    const Buffer size = device.upload<gpu::QueueSize>("bench.size", std::span(&all, 1));
    const Buffer source = device.upload<uint32_t>("bench.source", random),
                 flags = device.upload<uint32_t>("bench.flags", coin);
    const Buffer keys = device.array<uint32_t>("bench.keys", uint64_t(count) * 2);
    const Buffer values = device.array<uint32_t>("bench.values", count),
                 total = device.array<uint32_t>("bench.total", 1);
    const Buffer selected = device.array<gpu::QueueSize>("bench.selected", 1);
    const RadixSort sort(device, "bench.sort", count, 1, workers),
        long_sort(device, "bench.long_sort", count, 2, workers);
    const Scan scan(device, "bench.scan", count, workers);
    const SegmentedReduction reduction(device, "bench.reduction", count, SegmentedReduction::Type::kFloat);
    std::vector<uint32_t> segment(count);
    std::ranges::transform(random.begin(), random.begin() + count, segment.begin(),
                           [&](uint32_t r) { return r % (count / 16); });
    std::ranges::sort(segment);
    const Buffer segments = device.upload<uint32_t>("bench.segments", segment);
    const Compaction compaction(device, "bench.compaction", count, workers);

    Row row{.items = count, .ms = {}};
    constexpr uint32_t kWarmUp = 2;
    for (uint32_t repeat = 0; repeat < kWarmUp + repeats; ++repeat)
    {
        Recorder rec(device);
        rec.timeScopes(true);
        rec.begin();
        const auto timed = [&](size_t kind, auto&& record)
        {
            rec.copy(source, keys, uint64_t(count) * 2 * sizeof(uint32_t));
            rec.fill(total, 0); // ends the copy before the clock starts
            const auto scope = rec.scope(kKinds[kind]);
            record();
        };
        timed(0, [&] { sort.record(rec, keys, values, size, 30); });
        timed(1, [&] { sort.record(rec, keys, values, size, 32); });
        timed(2, [&] { long_sort.record(rec, keys, values, size, 64); });
        timed(3, [&] { scan.record(rec, source, values, total, size); });
        timed(4, [&] { compaction.record(rec, flags, values, selected, size); });
        timed(5, [&] { reduction.record(rec, flags, segments, values, size, count / 16); });
        const std::vector<StageTime> times = rec.submitAndWait();
        for (size_t kind = 0; repeat >= kWarmUp && kind < kKinds.size(); ++kind)
            row.ms[kind].push_back(times[kind].ms);
    }
    return row;
}

void printJson(std::span<const Row> rows, const Device& device)
{
    fmt::print("{{\"schema\": \"lumicut-bench-primitives/1\", \"device\": \"{}\", \"sizes\": [", device.name());
    for (size_t i = 0; i < rows.size(); ++i)
    {
        fmt::print("{}{{\"items\": {}", i > 0 ? ", " : "", rows[i].items);
        for (size_t kind = 0; kind < kKinds.size(); ++kind)
            fmt::print(", \"{0}_gitems_per_s\": {1:.6f}, \"{0}_ms\": {2:.6f}", kKeys[kind],
                       rows[i].gigaitemsPerSecond(kind), rows[i].median(kind));
        fmt::print("}}");
    }
    fmt::print("]}}\n");
}

void print(std::span<const Row> rows, const Device& device)
{
    fmt::print("{}, GItems/s (median milliseconds of {} runs)\n  {:<22}", device.name(), rows[0].ms[0].size(), "");
    for (const Row& row : rows)
        fmt::print("{:>20}", row.items);
    fmt::print("\n");
    for (size_t kind = 0; kind < kKinds.size(); ++kind)
    {
        fmt::print("  {:<22}", kKinds[kind]);
        for (const Row& row : rows)
            fmt::print("{:>20}", fmt::format("{:.4f} ({:.3f})", row.gigaitemsPerSecond(kind), row.median(kind)));
        fmt::print("\n");
    }
}
} // namespace

Status benchPrimitives(const PrimitiveBenchOptions& options)
{
    const auto instance = Instance::create({});
    if (!instance)
        return instance.error();
    const auto index = selectDevice(instance->devices(), options.device);
    if (!index)
        return index.error();
    const auto device = Device::create(*instance, *index);
    if (!device)
        return device.error();
    const Workers workers = options.workers == "groups"    ? Workers::kGroups
                            : options.workers == "threads" ? Workers::kThreads
                                                           : fastestWorkers(**device);
    std::vector<Row> rows;
    for (const uint32_t size : options.items)
        rows.push_back(measure(**device, size, workers, options.repeats));
    if (options.json)
        printJson(rows, **device);
    else
        print(rows, **device);
    return Success{};
}
