// The recorder's barriers, by chains of dispatches whose results are exact only in the order given, under
// synchronization validation; and what it says to callers who bind the wrong things.
#include "runtime/stages/rays.h"
#include "shaders/resolve/resolve.h"
#include "shaders/samples/samples.h"
#include "tests/stages/gpu_test.h"

#include <functional>

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
        rec.begin(VK_NULL_HANDLE);
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
        rec.runIndirect(accumulate_, size, 0, gpu::AccumulateParams{.pixel_count = count, .sample_count = 1},
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

TEST_F(RecorderTest, OrdersOneSubmissionAfterTheOther)
{
    const Buffer a = zeros(), b = filled(1);
    Recorder first(device()), second(device());
    for (int i = 0; i < 5; ++i)
    {
        first.begin(VK_NULL_HANDLE);
        add(first, b, a);
        first.submit(VK_NULL_HANDLE, VK_NULL_HANDLE);
        second.begin(VK_NULL_HANDLE);
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
    rec.begin(VK_NULL_HANDLE);
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
    rec.begin(VK_NULL_HANDLE);
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
    const Buffer words = device().array<gpu::DiffusePoint>("test.words", 1), points = device().array<gpu::SamplePoint>("test.points", 1);
    EXPECT_DEATH(
        {
            Recorder rec(device());
            rec.begin(VK_NULL_HANDLE);
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

TEST_F(RecorderDeathTest, RefusesScopesLeftOpenAndKernelsThatAreNotThere)
{
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(
        {
            Recorder rec(device());
            rec.begin(VK_NULL_HANDLE);
            const auto scope = rec.scope("left open");
            rec.submitAndWait();
        },
        "scope 'left open' is still open");
    EXPECT_DEATH((void)device().kernel("rays/nonsense"), "there is no kernel 'rays/nonsense'");
}
} // namespace
