// Sort, scan and compaction against the standard library's, on every kind of input and on both sides of each limit.
#include "runtime/stages/primitives.h"
#include "tests/stages/gpu_test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace
{
constexpr uint32_t kUntouched = 0xabcdabcd;

/// The same numbers in every run.
std::vector<uint32_t> randomWords(size_t count, uint32_t seed)
{
    std::mt19937 engine(seed);
    std::vector<uint32_t> words(count);
    std::ranges::generate(words, engine);
    return words;
}

class Primitives : public GpuTest
{
protected:
    static Buffer sizeOf(uint32_t count)
    {
        const gpu::QueueSize size{.count = count, .groups = {}};
        return device().upload<gpu::QueueSize>("test.size", std::span(&size, 1));
    }
    static Buffer words(std::span<const uint32_t> data)
    {
        static constexpr uint32_t kNothing[1]{kUntouched};
        return device().upload<uint32_t>("test.words", data.empty() ? kNothing : data);
    }
    static void submit(const std::function<void(Recorder&)>& record)
    {
        Recorder rec(device());
        rec.begin();
        record(rec);
        rec.submitAndWait();
    }
};

// ---- Scan and compaction -------------------------------------------------------------------------------------------

struct Lengths
{
    uint32_t max_count, count;
};

const Lengths kLengths[]{{1, 0},
                         {1, 1},
                         {2047, 2047},
                         {2048, 2048},
                         {2049, 2049},
                         {4096, 2049},
                         {10007, 10007},
                         {10007, 1},
                         {1 << 20, 4099},
                         {1 << 20, 0},
                         {300, 1000},
                         {524288, 524288},
                         {524289, 524289},
                         {(1 << 20) + 3, 1 << 20},
                         {1048579, 1048579}};

class OfLength : public Primitives, public testing::WithParamInterface<std::tuple<Lengths, Workers>>
{
protected:
    // A queue may overflow on the GPU: the count then exceeds the capacity.
    static Lengths lengths() { return std::get<0>(GetParam()); }
    static Workers workers() { return std::get<1>(GetParam()); }
    static uint32_t used() { return std::min(lengths().count, lengths().max_count); }
};

const char* nameOf(Workers workers)
{
    return workers == Workers::kGroups ? "Groups" : "Threads";
}

TEST_P(OfLength, ScanAddsUpWhatComesBefore)
{
    const auto [max_count, count] = lengths();
    const std::vector<uint32_t> values = randomWords(max_count, 1); // the sums wrap around many times
    const Buffer given = words(values), sums = device().array<uint32_t>("test.sums", max_count),
                 total = device().array<uint32_t>("test.total", 1), size = sizeOf(count);
    const Scan scan(device(), "test.scan", max_count, workers());
    submit(
        [&](Recorder& rec)
        {
            rec.fill(sums, kUntouched);
            rec.fill(total, kUntouched);
            scan.record(rec, given, sums, total, size);
        });
    std::vector<uint32_t> expected(max_count, kUntouched);
    std::exclusive_scan(values.begin(), values.begin() + used(), expected.begin(), 0u);
    EXPECT_EQ(device().download<uint32_t>(sums, max_count), expected);
    EXPECT_EQ(device().download<uint32_t>(total, 1)[0], std::accumulate(values.begin(), values.begin() + used(), 0u));
}

TEST_P(OfLength, ScanMayReplaceItsValues)
{
    const auto [max_count, count] = lengths();
    std::vector<uint32_t> expected = randomWords(max_count, 2);
    const Buffer values = words(expected), total = device().array<uint32_t>("test.total", 1), size = sizeOf(count);
    const Scan scan(device(), "test.scan", max_count, workers());
    submit([&](Recorder& rec) { scan.record(rec, values, values, total, size); });
    std::exclusive_scan(expected.begin(), expected.begin() + used(), expected.begin(), 0u);
    EXPECT_EQ(device().download<uint32_t>(values, max_count), expected);
}

TEST_P(OfLength, CompactionKeepsTheFlaggedInOrder)
{
    const auto [max_count, count] = lengths();
    const Compaction compaction(device(), "test.compaction", max_count, workers());
    for (const uint32_t kept_of_16 : {0u, 1u, 8u, 16u})
    {
        SCOPED_TRACE(kept_of_16);
        std::vector<uint32_t> flags = randomWords(max_count, 3);
        for (uint32_t& flag : flags)
            flag = flag % 16 < kept_of_16 ? flag | 1u << 31 : 0; // any value but 0 is set
        const Buffer given = words(flags), indices = device().array<uint32_t>("test.indices", max_count),
                     selected = device().array<gpu::QueueSize>("test.selected", 1), size = sizeOf(count);
        submit(
            [&](Recorder& rec)
            {
                rec.fill(indices, kUntouched);
                rec.fill(selected, kUntouched);
                compaction.record(rec, given, indices, selected, size);
            });
        std::vector<uint32_t> expected;
        for (uint32_t i = 0; i < used(); ++i)
            if (flags[i] != 0)
                expected.push_back(i);
        const uint32_t n = uint32_t(expected.size());
        expected.resize(max_count, kUntouched);
        EXPECT_EQ(device().download<uint32_t>(indices, max_count), expected);
        const auto made = device().download<gpu::QueueSize>(selected, 1)[0];
        EXPECT_EQ(made.count, n);
        expectGroups(made);
    }
}

INSTANTIATE_TEST_SUITE_P(
    , OfLength, testing::Combine(testing::ValuesIn(kLengths), testing::Values(Workers::kGroups, Workers::kThreads)),
    [](const auto& of)
    {
        const Lengths& lengths = std::get<0>(of.param);
        return fmt::format("{}Of{}By{}", lengths.count, lengths.max_count, nameOf(std::get<1>(of.param)));
    });

// ---- Segmented reduction -------------------------------------------------------------------------------------------

using Segments = std::vector<uint32_t>;

class Reduction : public Primitives, public testing::WithParamInterface<Lengths>
{
protected:
    static uint32_t used() { return std::min(GetParam().count, GetParam().max_count); }

    /// Ascending ones: one for all, one each, and some of every length from one to thousands, with gaps.
    static std::vector<Segments> kinds()
    {
        const uint32_t n = GetParam().max_count;
        Segments one(n, 3), each(n), mixed(n);
        std::iota(each.begin(), each.end(), 0u);
        const std::vector<uint32_t> random = randomWords(n, 6);
        uint32_t segment = 0, mean = 1;
        for (uint32_t i = 0; i < n; ++i)
        {
            if (random[i] % mean == 0)
            {
                segment += 1 + random[i] / mean % 3;
                mean = mean % 4096 * 2 + 1;
            }
            mixed[i] = segment;
        }
        return {one, each, mixed};
    }

    template <typename T>
    static std::vector<T> reduce(const std::vector<T>& values, const Segments& segments, uint32_t segment_count,
                                 SegmentedReduction::Type type)
    {
        const auto [max_count, count] = GetParam();
        const Buffer given = device().upload<T>("test.values", values), sorted = words(segments),
                     results = device().array<T>("test.results", segment_count), size = sizeOf(count);
        const SegmentedReduction reduction(device(), "test.reduction", max_count, type);
        submit([&](Recorder& rec) { reduction.record(rec, given, sorted, results, size, segment_count); });
        return device().download<T>(results, segment_count);
    }
};

TEST_P(Reduction, AddsUpEverySegment)
{
    const std::vector<uint32_t> values = randomWords(GetParam().max_count, 7);
    for (const Segments& segments : kinds())
        for (const uint32_t segment_count : {segments.back() + 5, segments.back() / 2 + 1}) // the rest is left out
        {
            std::vector<uint32_t> expected(segment_count, 0u);
            for (uint32_t i = 0; i < used(); ++i)
                if (segments[i] < segment_count)
                    expected[segments[i]] += values[i];
            EXPECT_EQ(reduce(values, segments, segment_count, SegmentedReduction::Type::kUint), expected);
        }
}

TEST_P(Reduction, AddsUpFloatsAsUintsWhereSumsAreExact)
{
    std::vector<uint32_t> values = randomWords(GetParam().max_count, 8);
    for (uint32_t& value : values)
        value %= 16; // sums below 2^24
    const std::vector<float> floats(values.begin(), values.end());
    std::vector<gpu::vec4> vectors;
    for (const float value : floats)
        vectors.push_back({value, -value, 2 * value, 16 - value});
    for (const Segments& segments : kinds())
    {
        const uint32_t segment_count = segments.back() + 1;
        const auto sums = reduce(floats, segments, segment_count, SegmentedReduction::Type::kFloat);
        const auto vector_sums = reduce(vectors, segments, segment_count, SegmentedReduction::Type::kVec4);
        std::vector<float> expected(segment_count, 0.0f), count_in(segment_count, 0.0f);
        for (uint32_t i = 0; i < used(); ++i)
        {
            expected[segments[i]] += floats[i];
            ++count_in[segments[i]];
        }
        EXPECT_EQ(sums, expected);
        uint32_t wrong = 0;
        for (uint32_t s = 0; s < segment_count; ++s)
            wrong += vector_sums[s].x != expected[s] || vector_sums[s].y != -expected[s] ||
                     vector_sums[s].z != 2 * expected[s] || vector_sums[s].w != 16 * count_in[s] - expected[s];
        EXPECT_EQ(wrong, 0u);
    }
}

TEST_P(Reduction, AddsUpFloatsInTheSameOrderEveryTime)
{
    const std::vector<uint32_t> random = randomWords(GetParam().max_count, 9);
    std::vector<float> values;
    for (const uint32_t r : random)
        values.push_back(std::ldexp(float(r >> 8), -int(r % 32))); // of all sizes: any other order rounds otherwise
    const Segments segments = kinds().back();
    const uint32_t segment_count = segments.back() + 1;
    const auto sums = reduce(values, segments, segment_count, SegmentedReduction::Type::kFloat);
    EXPECT_EQ(reduce(values, segments, segment_count, SegmentedReduction::Type::kFloat), sums);
    std::vector<double> expected(segment_count, 0.0);
    for (uint32_t i = 0; i < used(); ++i)
        expected[segments[i]] += values[i];
    // A value takes part in kReduceItems - 1 additions a level, and all are positive.
    const double levels = 1 + std::ceil(std::log(std::max(GetParam().max_count, 2u)) / std::log(gpu::kReduceItems / 2));
    for (uint32_t s = 0; s < segment_count; ++s)
        ASSERT_NEAR(sums[s], expected[s], expected[s] * levels * gpu::kReduceItems * 0x1p-24) << s;
}

INSTANTIATE_TEST_SUITE_P(, Reduction,
                         testing::Values(Lengths{1, 0}, Lengths{1, 1}, Lengths{31, 31}, Lengths{32, 32},
                                         Lengths{33, 33}, Lengths{512, 512}, Lengths{513, 513}, Lengths{300, 1000},
                                         Lengths{10007, 10007}, Lengths{262147, 40}, Lengths{262147, 262147},
                                         Lengths{1048579, 1048579}),
                         [](const auto& of) { return fmt::format("{}Of{}", of.param.count, of.param.max_count); });

// ---- Sort ----------------------------------------------------------------------------------------------------------

struct SortCase
{
    const char* name;
    uint32_t max_count, count, key_words, key_bits;
};

const SortCase kSorts[]{{"Nothing", 1000, 0, 1, 32},
                        {"One", 1, 1, 1, 32},
                        {"Two", 2, 2, 2, 64},
                        {"FewOf30Bits", 4096, 4096, 1, 30},
                        {"FewOf64Bits", 4096, 4093, 2, 64},
                        {"FewOfTheirRoom", 100000, 300, 1, 32},
                        {"MoreThanTheirRoom", 300, 1000, 1, 32},
                        {"JustMoreThanFew", 4097, 4097, 1, 30},
                        {"OneBit", 10007, 10007, 1, 1},
                        {"FiveBits", 10007, 10007, 1, 5},
                        {"PrimeOf17Bits", 10007, 10007, 1, 17},
                        {"PrimeOf40Bits", 10007, 10007, 2, 40},
                        {"PrimeOf63Bits", 20011, 20011, 2, 63},
                        {"LowWordOnly", 20011, 20011, 2, 30},
                        {"ManyOf32Bits", 200003, 200003, 1, 32},
                        {"ManyOf64Bits", 65537, 65537, 2, 64},
                        {"HalfOfTheirRoom", 1 << 18, 1 << 17, 1, 32}};

const SortCase kMillions[]{{"MillionOf30Bits", (1 << 20) + 3, (1 << 20) + 3, 1, 30}};

class Sort : public Primitives, public testing::WithParamInterface<std::tuple<SortCase, Workers>>
{
protected:
    using Keys = std::vector<uint64_t>;

    /// Sorts on both, and expects the very same order of keys, all of their bits, and of values.
    static void expectSorted(const Keys& keys)
    {
        const auto& [c, workers] = GetParam();
        std::vector<uint32_t> key_words;
        for (const uint64_t key : keys)
        {
            key_words.push_back(uint32_t(key));
            if (c.key_words > 1)
                key_words.push_back(uint32_t(key >> 32));
        }
        std::vector<uint32_t> order(keys.size());
        std::iota(order.begin(), order.end(), 0u);
        const Buffer sorted_keys = words(key_words), sorted_values = words(order), size = sizeOf(c.count);
        const RadixSort sort(device(), "test.sort", c.max_count, c.key_words, workers);
        submit([&](Recorder& rec) { sort.record(rec, sorted_keys, sorted_values, size, c.key_bits); });

        const uint64_t mask = ~0ull >> (64 - c.key_bits);
        std::stable_sort(order.begin(), order.begin() + std::min(c.count, c.max_count),
                         [&](uint32_t a, uint32_t b) { return (keys[a] & mask) < (keys[b] & mask); });
        ASSERT_EQ(device().download<uint32_t>(sorted_values, keys.size()), order);
        std::vector<uint32_t> expected_words;
        for (const uint32_t i : order)
            for (uint32_t word = 0; word < c.key_words; ++word)
                expected_words.push_back(key_words[i * c.key_words + word]);
        ASSERT_EQ(device().download<uint32_t>(sorted_keys, expected_words.size()), expected_words);
    }

    static Keys randomKeys()
    {
        const auto& c = std::get<0>(GetParam());
        const std::vector<uint32_t> low = randomWords(c.max_count, 4), high = randomWords(c.max_count, 5);
        Keys keys;
        for (uint32_t i = 0; i < c.max_count; ++i)
            keys.push_back(c.key_words > 1 ? uint64_t(high[i]) << 32 | low[i] : low[i]);
        return keys;
    }
};

TEST_P(Sort, OrdersRandomKeys)
{
    expectSorted(randomKeys());
}

// Takes long by groups where threads run one after the other: random keys will do.
class LongSort : public Sort
{
};

TEST_P(LongSort, OrdersRandomKeys)
{
    expectSorted(randomKeys());
}

TEST_P(Sort, LeavesEqualKeysInTheirOrder)
{
    Keys keys = randomKeys();
    const uint64_t all = keys[0];
    for (uint64_t& key : keys) // a few kinds of keys, then one
        key = (key % 3) * (all | 1);
    expectSorted(keys);
    std::ranges::fill(keys, all);
    expectSorted(keys);
}

TEST_P(Sort, OrdersSortedAndReversedKeys)
{
    Keys keys = randomKeys();
    std::ranges::sort(keys);
    expectSorted(keys);
    std::ranges::reverse(keys);
    expectSorted(keys);
}

std::string sortName(const testing::TestParamInfo<std::tuple<SortCase, Workers>>& sort)
{
    return fmt::format("{}By{}", std::get<0>(sort.param).name, nameOf(std::get<1>(sort.param)));
}

const auto kBoth = testing::Values(Workers::kGroups, Workers::kThreads);
INSTANTIATE_TEST_SUITE_P(, Sort, testing::Combine(testing::ValuesIn(kSorts), kBoth), sortName);
INSTANTIATE_TEST_SUITE_P(, LongSort, testing::Combine(testing::ValuesIn(kMillions), kBoth), sortName);
} // namespace
