// Sort, scan, compaction, segmented reduction: what stages build their lists with. Counts are made on the GPU and never
// read back. Every one is a stage's member: it allocates its scratch in its constructor and borrows everything else.
#pragma once
#include "runtime/gpu/gpu.h"
#include "shaders/primitives/primitives.h"

#include <optional>
#include <string_view>

// In all of them `size` is a gpu::QueueSize whose .count the kernels read (its .groups is not read); a count above
// max_count counts as max_count. Where work is divided, lower indices belong to lower workers, so that the results do
// not depend on the order in which workers run: equal input gives equal bits.

/// The unit that processes a part of the work: a workgroup, tile by tile in shared memory, or a single thread, which is faster where
/// threads run one after the other.
enum class Workers
{
    kGroups,
    kThreads
};

/// What is faster on the device; the constructors' default.
Workers fastestWorkers(const Device& device);

/// A stable radix sort of key-value pairs by the keys' lowest bits.
class RadixSort
{
public:
    /// @param key_words 1: uint keys, 2: uvec2 keys with the low word in x
    RadixSort(const Device& device, std::string_view name, uint32_t max_count, uint32_t key_words = 1,
              std::optional<Workers> workers = {}, const Scratch& scratch = {});
    static uint64_t scratchBytes(uint32_t max_count, uint32_t key_words, Workers workers);

    /// Sorts keys[0, count) ascending by their lowest `key_bits` bits, stably, and values with them, in place.
    /// @param keys uint[max_count] or uvec2[max_count]; higher bits may be anything and stay with their keys
    /// @param values uint[max_count]
    /// @param key_bits 1 to 32 * key_words; fewer bits take fewer passes
    void record(Recorder& rec, const Buffer& keys, const Buffer& values, const Buffer& size, uint32_t key_bits) const;

private:
    struct Pairs
    {
        const Buffer& keys;
        const Buffer& values;
    };
    void recordPass(Recorder& rec, const Pairs& from, const Pairs& to, const Buffer& size,
                    const gpu::SortParams& params) const;

    uint32_t max_count_, key_words_;
    Workers workers_;
    uint32_t worker_count_;
    bool in_one_group_; // and in one dispatch, without scratch
    Kernel small_, count_, offsets_, move_;
    Buffer keys_, values_, counts_, totals_; // scratch
};

/// The exclusive prefix sum of uints, modulo 2^32.
class Scan
{
public:
    Scan(const Device& device, std::string_view name, uint32_t max_count, std::optional<Workers> workers = {});

    /// sums[i] = values[0] + ... + values[i - 1] for i < count.
    /// @param values, sums uint[max_count]; may be the same buffer
    /// @param total uint that becomes the sum of all; not one of the others
    void record(Recorder& rec, const Buffer& values, const Buffer& sums, const Buffer& total, const Buffer& size) const;

private:
    gpu::ScanParams params_;
    Kernel sum_, scan_;
    Buffer group_sums_;
};

/// The places of the flags that are set.
class Compaction
{
public:
    Compaction(const Device& device, std::string_view name, uint32_t max_count, std::optional<Workers> workers = {});

    /// indices[0, n) become the i < count with flags[i] != 0, ascending.
    /// @param flags uint[max_count], @param indices uint[max_count]; not the same buffer
    /// @param selected gpu::QueueSize that becomes n, ready for indirect dispatch; not `size` itself
    void record(Recorder& rec, const Buffer& flags, const Buffer& indices, const Buffer& selected,
                const Buffer& size) const;

private:
    gpu::ScanParams params_;
    Kernel sum_, compact_;
    Buffer group_sums_;
};

/// The sums of what lies in each segment of a list that is sorted by segment. Every sum is made in one and the same
/// order for the same segments, of neighbours first: floats too come out equal bit by bit, on every device that rounds
/// as IEEE 754 says.
class SegmentedReduction
{
public:
    enum class Type
    {
        kUint, // modulo 2^32
        kFloat,
        kVec4
    };
    SegmentedReduction(const Device& device, std::string_view name, uint32_t max_count, Type type);

    /// results[s] = sum of the values[i] with segments[i] == s, i < count; 0 where there are none.
    /// @param values `type`[max_count]
    /// @param segments uint[max_count], ascending; values of segments from segment_count on are left out
    /// @param results `type`[segment_count]; the whole buffer is cleared first
    void record(Recorder& rec, const Buffer& values, const Buffer& segments, const Buffer& results, const Buffer& size,
                uint32_t segment_count) const;

private:
    uint32_t max_count_;
    Kernel reduce_;
    struct Level
    {
        Buffer segments, values;
    };
    Level levels_[2]; // of odd and of even levels
};
