// The recorder's barriers, by chains of dispatches whose results are exact only in the order given, under
// synchronization validation; and its messages about wrong bindings.
#include "runtime/stages/rays.h"
#include "shaders/gather/harmonics.h"
#include "shaders/resolve/resolve.h"
#include "shaders/samples/samples.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/triangle_scene.h"

#include <cstring>
#include <functional>
#include <numeric>
#include <utility>

namespace
{
constexpr uint32_t kElements = 100000; // vec3s: many groups, so that dispatches without barriers would overlap

class RecorderTest : public GpuTest
{
protected:
    RecorderTest()
        : accumulate_(device().kernel("resolve/accumulate")), set_size_(device().kernel("rays/set_size")),
          dispatch_size_(device().kernel("rays/dispatch_size"))
    {
    }

    static Buffer filled(float value)
    {
        const std::vector<gpu::vec3> data(kElements, {value, value, value});
        return device().upload<gpu::vec3>("test.data", data);
    }
    static Buffer zeros() { return filled(0); }

    /// sum += added, element by element.
    void add(Recorder& rec, const Buffer& added, const Buffer& sum) const
    {
        rec.run(accumulate_, kElements, gpu::AccumulateParams{.pixel_count = kElements, .sample_count = 1},
                {{"Radiance", added}, {"Sum", sum}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
    }

    static void submit(const std::function<void(Recorder&)>& record)
    {
        Recorder rec(device());
        rec.begin();
        record(rec);
        rec.submitAndWait();
    }

    static void expectAll(const Buffer& buffer, float value)
    {
        uint32_t wrong = 0;
        for (const gpu::vec3& v : device().download<gpu::vec3>(buffer, kElements))
            wrong += v.x != value || v.y != value || v.z != value;
        EXPECT_EQ(wrong, 0u) << "of " << kElements << " are not " << value;
    }

    Kernel accumulate_, set_size_, dispatch_size_;
    Buffer compensation_ = zeros(); // stays 0 as long as sums are exact
    Buffer non_finite_ = device().array<uint32_t>("test.non_finite", 1);
    Buffer other_non_finite_ = device().array<uint32_t>("test.other_non_finite", 1);
};

TEST_F(RecorderTest, OrdersReadsAfterWritesAndWritesAfterReads)
{
    // a += b, b += a, ... makes Fibonacci numbers: every dispatch reads what the last wrote and writes what it read.
    const Buffer a = zeros(), b = filled(1);
    submit(
        [&](Recorder& rec)
        {
            for (int i = 0; i < 15; ++i)
            {
                add(rec, b, a);
                add(rec, a, b);
            }
        });
    expectAll(a, 832040);  // F(30)
    expectAll(b, 1346269); // F(31)
}

TEST_F(RecorderTest, OrdersFillsCopiesAndDispatches)
{
    const Buffer one = filled(1), sum = zeros(), kept = zeros();
    constexpr uint32_t kTwo = 0x40000000; // 2.0f
    submit(
        [&](Recorder& rec)
        {
            for (int i = 0; i < 10; ++i)
            {
                rec.fill(sum, kTwo);                                // after the copy below has read it
                add(rec, one, sum);                                 // 3
                rec.copy(sum, kept, kElements * sizeof(gpu::vec3)); // 3
                rec.clear(sum);
                add(rec, kept, sum); // 3
                add(rec, sum, kept); // 6
            }
            rec.copy(sum, one, kElements * sizeof(gpu::vec3)); // while nothing reads the ones any more
            add(rec, one, kept);                               // 9
        });
    expectAll(sum, 3);
    expectAll(kept, 9);
    expectAll(one, 3);
}

TEST_F(RecorderTest, OrdersIndirectDispatchesAfterTheirCountAndTheNextCountAfterThem)
{
    const Buffer one = filled(1), sum = zeros(), size = device().array<gpu::QueueSize>("test.size", 1);
    const auto addFirst = [&](Recorder& rec, uint32_t count)
    {
        rec.run(set_size_, 1, gpu::QueueParams{.count = count}, {{"Queue", size}});
        rec.run(dispatch_size_, 1, NoParams{}, {{"Queue", size}});
        rec.runIndirect(accumulate_, size, gpu::AccumulateParams{.pixel_count = count, .sample_count = 1},
                        {{"Radiance", one}, {"Sum", sum}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
    };
    constexpr uint32_t kSteps = 40;
    const auto countOf = [](uint32_t step) { return (step * 7919) % kElements + 1; };
    submit(
        [&](Recorder& rec)
        {
            for (uint32_t step = 0; step < kSteps; ++step)
                addFirst(rec, countOf(step));
        });
    std::vector<float> expected(kElements + 1); // a difference a step, then their running sum from behind
    for (uint32_t step = 0; step < kSteps; ++step)
        ++expected[countOf(step) - 1];
    for (uint32_t i = kElements; i-- > 0;)
        expected[i] += expected[i + 1];
    const auto sums = device().download<gpu::vec3>(sum, kElements);
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < kElements; ++i)
        wrong += sums[i].x != expected[i];
    EXPECT_EQ(wrong, 0u);
}

/// How many of kCount elements a kernel reaches that is dispatched by a QueueSize in which only `row` has groups.
class IndirectGroups : public RecorderTest
{
protected:
    static constexpr uint32_t kCount = 5000; // no multiple of any group size

    static gpu::QueueSize onlyRow(uint32_t row, uint32_t fewer_groups)
    {
        gpu::QueueSize size = gpu::queueSize(kCount);
        for (uint32_t r = 0; r < gpu::kQueueRows; ++r)
            size.groups[r].x = r == row ? size.groups[r].x - fewer_groups : 0;
        return size;
    }

    /// A kernel of 64 threads a group.
    uint32_t reachedBy64(const gpu::QueueSize& made) const
    {
        const Buffer size = device().upload<gpu::QueueSize>("test.size", std::span(&made, 1)), one = filled(1),
                     sum = zeros();
        submit(
            [&](Recorder& rec)
            {
                rec.runIndirect(
                    accumulate_, size, gpu::AccumulateParams{.pixel_count = kCount, .sample_count = 1},
                    {{"Radiance", one}, {"Sum", sum}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
            });
        return uint32_t(std::ranges::count(device().download<gpu::vec3>(sum, kElements), 1.0f, &gpu::vec3::x));
    }

    /// A kernel of 256.
    uint32_t reachedBy256(const gpu::QueueSize& made) const
    {
        const Kernel mark = device().kernel("samples/occupied");
        EXPECT_EQ(mark.code().group_size, 256u);
        const Buffer size = device().upload<gpu::QueueSize>("test.size", std::span(&made, 1)),
                     sums = device().array<gpu::ClusterSums>("test.sums", kCount),
                     flags = device().array<uint32_t>("test.flags", kCount);
        submit(
            [&](Recorder& rec)
            {
                rec.fill(sums, 1);
                rec.clear(flags);
                rec.runIndirect(mark, size, NoParams{}, {{"Size", size}, {"Sums", sums}, {"Flags", flags}});
            });
        uint32_t reached = 0;
        for (const uint32_t flag : device().download<uint32_t>(flags, kCount))
            reached += flag;
        return reached;
    }
};

TEST_F(IndirectGroups, AreThoseOfTheKernelsOwnSize)
{
    EXPECT_EQ(accumulate_.code().group_size, 64u);
    EXPECT_EQ(reachedBy64(onlyRow(0, 0)), kCount);
    EXPECT_EQ(reachedBy64(onlyRow(0, 1)), kCount / 64 * 64); // the last group is needed
    EXPECT_EQ(reachedBy64(onlyRow(2, 0)), 0u);               // others are not looked at
    EXPECT_EQ(reachedBy256(onlyRow(2, 0)), kCount);
    EXPECT_EQ(reachedBy256(onlyRow(2, 1)), kCount / 256 * 256);
    EXPECT_EQ(reachedBy256(onlyRow(0, 0)), 0u);
}

TEST_F(IndirectGroups, CoverTheCountAndNoMore)
{
    for (const uint32_t count : {0u, 1u, 63u, 64u, 65u, 127u, 128u, 129u, 255u, 256u, 257u, (1u << 26) - 1})
        expectGroups(gpu::queueSize(count));
}

TEST_F(RecorderTest, OrdersReadsOfTheSceneAsOfAnyOtherBuffer)
{
    const LoadedScene scene = []
    {
        TriangleScene s;
        s.triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 1}); // z = y / 4
        return s.load(device());
    }();
    const SceneSet set = scene.gpu->descriptorSet();
    const Buffer &triangles = *set.buffers[gpu::kBvhTrianglesBinding], &lights = *set.buffers[gpu::kLightsBinding];
    const auto before = device().download<gpu::BvhTriangle>(triangles, 1);
    auto after = before;
    for (gpu::vec3* vertex : {&after[0].v0, &after[0].v1, &after[0].v2})
        vertex->z = 0.25f; // within the tree's boxes
    const std::vector<gpu::Ray> ray(1, {.origin = {0.5f, 2, 5}, .t_max = 10, .direction = {0, 0, -1}, .path = 0});
    const RayStage stage(device(), *scene.gpu);
    RayQueue queue(device(), "test.queue", 1);
    queue.rays = device().uploadTexels<gpu::Ray>("test.rays", ray);
    std::vector<Buffer> hits;
    for (int i = 0; i < 5; ++i)
        hits.push_back(device().array<gpu::Hit>("test.hits", 1));

    Recorder rec(device());
    rec.timeScopes(true); // as recorded
    rec.begin(set);
    uint32_t barriers = rec.barrierCount();
    const auto more = [&] { return rec.barrierCount() - std::exchange(barriers, rec.barrierCount()); };
    stage.resize(rec, queue.size, 1);
    stage.closest(rec, queue, hits[0], 0);
    EXPECT_EQ(more(), 1u); // for the queue's size
    stage.closest(rec, queue, hits[1], 0);
    EXPECT_EQ(more(), 0u); // two that read
    rec.write(triangles, 0, std::as_bytes(std::span(after)));
    EXPECT_EQ(more(), 1u);
    stage.closest(rec, queue, hits[2], 0);
    EXPECT_EQ(more(), 1u);
    rec.write(lights, 0, std::as_bytes(std::span(after)).first(4));
    stage.closest(rec, queue, hits[3], 0);
    EXPECT_EQ(more(), 0u); // rays do not read lights
    rec.run(
        accumulate_, 0, gpu::AccumulateParams{.pixel_count = 0, .sample_count = 1}, // a kernel's output
        {{"Radiance", compensation_}, {"Sum", triangles}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
    EXPECT_EQ(more(), 1u);
    stage.closest(rec, queue, hits[4], 0);
    EXPECT_EQ(more(), 1u);
    rec.submitAndWait();
    for (const auto& [hit, t] : {std::pair(0, 4.5f), {1, 4.5f}, {2, 4.75f}, {3, 4.75f}, {4, 4.75f}})
        EXPECT_FLOAT_EQ(device().download<gpu::Hit>(hits[hit], 1)[0].t, t) << "hit " << hit;
}

TEST_F(RecorderTest, RunsWhatDoesNotDependOnEachOtherSideBySide)
{
    // Fibonacci numbers twice, recorded one chain after the other: as many barriers as one chain takes.
    const Buffer other_compensation = zeros();
    const auto chain = [&](Recorder& rec, const Buffer& even, const Buffer& odd, const Buffer& compensation)
    {
        for (int i = 0; i < 15; ++i)
            for (const auto& [added, sum] : {std::pair(&odd, &even), std::pair(&even, &odd)})
                rec.run(accumulate_, kElements, gpu::AccumulateParams{.pixel_count = kElements, .sample_count = 1},
                        {{"Radiance", *added},
                         {"Sum", *sum},
                         {"Compensation", compensation},
                         {"NonFinite", &compensation == &compensation_ ? non_finite_ : other_non_finite_}});
    };
    for (const bool timed : {false, true})
    {
        const Buffer a = zeros(), b = filled(1), c = zeros(), d = filled(1);
        Recorder rec(device());
        rec.timeScopes(timed);
        rec.begin();
        {
            const auto scope = rec.scope("first");
            chain(rec, a, b, compensation_);
        }
        {
            const auto scope = rec.scope("second");
            chain(rec, c, d, other_compensation);
        }
        const std::vector<StageTime> times = rec.submitAndWait();
        EXPECT_EQ(rec.barrierCount(),
                  1 + (timed ? 58u : 29u)); // begin()'s, and one before each of a chain but its first
        EXPECT_EQ(times.size(), timed ? 2u : 1u);
        for (const Buffer* even : {&a, &c})
            expectAll(*even, 832040);
        for (const Buffer* odd : {&b, &d})
            expectAll(*odd, 1346269);
    }
}

TEST_F(RecorderTest, WritesOfAnySizeTakeOneBarrierAndNoMemoryOnceTheyHaveBeen)
{
    constexpr uint32_t kWords = 1'000'000, kBefore = 3;
    const Buffer to = device().array<uint32_t>("test.words", kBefore + kWords + 1);
    std::vector<uint32_t> words(kWords);
    Recorder rec(device());
    rec.timeScopes(true); // as recorded
    uint64_t allocations = 0;
    for (uint32_t submission = 0; submission < 3; ++submission)
    {
        rec.begin();
        rec.fill(to, 7);
        const uint32_t barriers = rec.barrierCount();
        std::iota(words.begin(), words.end(), submission);
        rec.write(to, kBefore * sizeof(uint32_t), std::as_bytes(std::span(words)));
        EXPECT_EQ(rec.barrierCount(), barriers + 1);
        std::ranges::fill(words, 0u); // has been taken
        const std::vector<uint32_t> next(20000, 9);
        rec.write(to, kBefore * sizeof(uint32_t), std::as_bytes(std::span(next)));
        rec.submitAndWait();
        if (submission == 2)
        {
            EXPECT_EQ(device().allocationCount(), allocations);
        }
        const auto found = device().download<uint32_t>(to, kBefore + kWords + 1);
        uint32_t wrong = found.front() != 7 || found.back() != 7;
        for (uint32_t i = 0; i < kWords; ++i)
            wrong += found[kBefore + i] != (i < next.size() ? 9 : submission + i);
        EXPECT_EQ(wrong, 0u);
        if (submission == 1)
            allocations = device().allocationCount();
    }
}

TEST_F(RecorderTest, OrdersStagesThatShareMemory)
{
    constexpr uint32_t kTwo = 0x40000000, kThree = 0x40400000; // floats
    const ScratchPool pool;
    const Scratch first = pool.stage(), second = pool.stage();
    const Buffer a = device().array<gpu::vec3>("test.a", kElements, first);
    const Buffer a_too = device().array<gpu::vec3>("test.a_too", kElements, first);
    const uint64_t bytes = device().allocatedBytes();
    const Buffer b = device().array<gpu::vec3>("test.b", kElements / 2, second);
    const Buffer b_too = device().array<gpu::vec3>("test.b_too", kElements, second);
    EXPECT_EQ(device().allocatedBytes(), bytes);
    EXPECT_FALSE(a.range().overlaps(a_too.range()));
    EXPECT_FALSE(b.range().overlaps(b_too.range()));
    EXPECT_TRUE(a.range().overlaps(b.range()));

    const Buffer sum = zeros();
    submit(
        [&](Recorder& rec)
        {
            rec.clear(non_finite_);
            for (int i = 0; i < 10; ++i)
            {
                rec.fill(a, kTwo);
                add(rec, a, sum);
                rec.fill(b, kThree); // where a was
                rec.fill(b_too, kThree);
                add(rec, b_too, sum);
            }
        });
    expectAll(sum, 50);
}

TEST_F(RecorderTest, OrdersOneSubmissionAfterTheOther)
{
    const Buffer a = zeros(), b = filled(1);
    Recorder first(device()), second(device());
    for (int i = 0; i < 5; ++i)
    {
        first.begin();
        add(first, b, a);
        first.submit(VK_NULL_HANDLE, VK_NULL_HANDLE);
        second.begin();
        add(second, a, b);
        second.submit(VK_NULL_HANDLE, VK_NULL_HANDLE);
        first.wait();
        second.wait();
    }
    expectAll(a, 55); // F(10)
    expectAll(b, 89);
}

TEST_F(RecorderTest, RunsNothingForNoThreads)
{
    const Buffer one = filled(1), sum = zeros();
    submit(
        [&](Recorder& rec)
        {
            rec.run(accumulate_, 0, gpu::AccumulateParams{.pixel_count = kElements, .sample_count = 1},
                    {{"Radiance", one}, {"Sum", sum}, {"Compensation", compensation_}, {"NonFinite", non_finite_}});
        });
    expectAll(sum, 0);
}

TEST_F(RecorderTest, TimesScopesOfOneNameTogether)
{
    const Buffer one = filled(1), sum = zeros();
    Recorder rec(device());
    rec.timeScopes(true);
    rec.begin();
    {
        const auto whole = rec.scope("whole");
        for (int i = 0; i < 3; ++i)
        {
            const auto part = rec.scope("part");
            add(rec, one, sum);
        }
    }
    const std::vector<StageTime> times = rec.submitAndWait();
    ASSERT_EQ(times.size(), 2u);
    EXPECT_EQ(times[0].name, "whole");
    EXPECT_EQ(times[1].name, "part");
    EXPECT_GT(times[1].ms, 0);
    EXPECT_LE(times[1].ms, times[0].ms);
}

// ---- Callers' mistakes ---------------------------------------------------------------------------------------------

using RecorderDeathTest = RecorderTest;

/// Runs resolve/tonemap with these bindings and parameters.
template <typename Params>
void runTonemap(const Device& device, const Params& params, std::initializer_list<Binding> bindings)
{
    const Kernel tonemap = device.kernel("resolve/tonemap");
    Recorder rec(device);
    rec.begin();
    rec.run(tonemap, 1, params, bindings);
}

TEST_F(RecorderDeathTest, NamesTheKernelsBlocksWhereABindingIsWrong)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // the device has threads
    const Buffer a = zeros();
    const gpu::TonemapParams params{};
    EXPECT_DEATH(runTonemap(device(), params, {{"Sum", a}, {"Pixel", a}}),
                 "resolve/tonemap: no block 'Pixel'; its blocks are Sum Pixels|resolve/tonemap: no block 'Pixel'; its "
                 "blocks are Pixels Sum");
    EXPECT_DEATH(runTonemap(device(), params, {{"Sum", a}}),
                 "resolve/tonemap: 1 buffers given, the kernel's blocks are (Sum Pixels|Pixels Sum)");
    EXPECT_DEATH(runTonemap(device(), params, {{"Sum", a}, {"Pixels", a}, {"More", a}}),
                 "resolve/tonemap: 3 buffers given");
    EXPECT_DEATH(runTonemap(device(), params, {{"Sum", a}, {"Sum", a}}),
                 "resolve/tonemap: block 'Sum' is given twice; its blocks are (Sum Pixels|Pixels Sum)");
}

TEST_F(RecorderDeathTest, NamesABufferThatIsReadAsTexelsWithoutAView)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Kernel kernel = device().kernel("samples/points");
    const Buffer words = device().array<gpu::DiffusePoint>("test.words", 1),
                 points = device().array<gpu::SamplePoint>("test.points", 1);
    EXPECT_DEATH(
        {
            Recorder rec(device());
            rec.begin();
            rec.run(kernel, 1, gpu::PointParams{}, {{"DiffusePoints", words}, {"Points", points}});
        },
        "samples/points: 'DiffusePoints' is read as texels, but buffer 'test.words' has no texel view");
}

TEST_F(RecorderDeathTest, RefusesParametersOfAnotherSize)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Buffer a = zeros();
    EXPECT_DEATH(runTonemap(device(), gpu::AccumulateParams{}, {{"Sum", a}, {"Pixels", a}}),
                 "resolve/tonemap: 8 bytes of parameters given, the kernel has 16");
    EXPECT_DEATH(runTonemap(device(), NoParams{}, {{"Sum", a}, {"Pixels", a}}),
                 "resolve/tonemap: 0 bytes of parameters given, the kernel has 16");
}

TEST_F(RecorderDeathTest, RefusesIndirectDispatchesWithoutGroupsOfTheKernelsSize)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Buffer size = device().array<gpu::QueueSize>("test.size", 1), word = device().array<uint32_t>("test.word", 1);
    const auto run = [&](const Buffer& given) {
        submit(
            [&](Recorder& rec) {
                rec.runIndirect(set_size_, given, gpu::QueueParams{.count = 1}, {{"Queue", size}});
            });
    };
    EXPECT_DEATH(run(size), "rays/set_size: a QueueSize has no dispatch for groups of 1 threads");
    EXPECT_DEATH(run(word), "rays/set_size: buffer 'test.word' of 4 bytes is no QueueSize");
}

TEST_F(RecorderDeathTest, RefusesConstantsThatNoKernelUses)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const std::array scene{Constant{"kSceneFeatures", 0}}, nonsense{Constant{"kNonsense", 0}};
    EXPECT_EQ(device().pipeline(device().kernel("resolve/tonemap", SharedConstants(scene))),
              device().pipeline(device().kernel("resolve/tonemap")));
    EXPECT_NE(device().pipeline(device().kernel("primitives/sum", {{"kFlags", 1}})),
              device().pipeline(device().kernel("primitives/sum", {{"kFlags", 0}})));
    EXPECT_DEATH((void)device().kernel("resolve/tonemap", {{"kSceneFeatures", 0}}),
                 "resolve/tonemap: it uses no specialization constant 'kSceneFeatures'");
    EXPECT_DEATH((void)device().kernel("resolve/tonemap", SharedConstants(nonsense)),
                 "no kernel uses a specialization constant 'kNonsense'");
    EXPECT_DEATH((void)device().kernel("primitives/sum", {{"kFlags", 1}, {"kFlags", 0}}),
                 "primitives/sum: a specialization constant is given twice");
}

TEST_F(RecorderDeathTest, RefusesKernelsThatReadASceneWhereNoneIsGiven)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const Buffer word = device().array<gpu::QueueSize>("test.word", 1), radiance = zeros();
    EXPECT_DEATH(submit(
                     [&](Recorder& rec)
                     {
                         rec.run(device().kernel("rays/visible"), 1, NoParams{},
                                 {{"Queue", word}, {"ShadowRays", word}, {"Radiance", radiance}});
                     }),
                 "rays/visible: it reads binding . of the scene, of 0 given to begin");
}

TEST_F(RecorderDeathTest, RefusesScopesLeftOpenAndKernelsThatAreNotThere)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            Recorder rec(device());
            rec.begin();
            const auto scope = rec.scope("left open");
            rec.submitAndWait();
        },
        "scope 'left open' is still open");
    EXPECT_DEATH((void)device().kernel("rays/nonsense"), "there is no kernel 'rays/nonsense'");
}
} // namespace
