// What a trace tells of commands, and that commands do the same under it.
#include "runtime/stages/rays.h"
#include "shaders/resolve/resolve.h"
#include "tests/stages/gpu_test.h"

namespace
{
constexpr uint32_t kElements = 1000;

class CommandTraceTest : public GpuTest
{
protected:
    /// Doubles ones by a fill, a copy, a dispatch and an indirect one of `count` threads. @return the sums
    static std::vector<gpu::vec3> traced(CommandTrace& trace, uint32_t count)
    {
        const Kernel accumulate = device().kernel("resolve/accumulate"), set_size = device().kernel("rays/set_size");
        const std::vector<gpu::vec3> ones(kElements, {1, 1, 1});
        const Buffer one = device().upload<gpu::vec3>("test.one", ones);
        const Buffer sum = device().array<gpu::vec3>("test.sum", kElements);
        const Buffer lost = device().array<gpu::vec3>("test.lost", kElements);
        const Buffer wrong = device().array<uint32_t>("test.wrong", 1);
        const Buffer size = device().array<gpu::QueueSize>("test.size", 1);
        Recorder rec(device());
        rec.traceInto(&trace);
        rec.begin();
        {
            const auto outer = rec.scope("outer");
            rec.clear(lost);
            rec.copy(one, sum, kElements * sizeof(gpu::vec3));
            const auto inner = rec.scope("inner");
            rec.run(set_size, 1, gpu::QueueParams{.count = count}, {{"Queue", size}});
            rec.runIndirect(accumulate, size, gpu::AccumulateParams{.pixel_count = kElements, .sample_count = 1},
                            {{"Radiance", one}, {"Sum", sum}, {"Compensation", lost}, {"NonFinite", wrong}});
        }
        rec.submitAndWait();
        return device().download<gpu::vec3>(sum, kElements);
    }
};

TEST_F(CommandTraceTest, NamesCommandsWithTheirGroupsAndBytes)
{
    const uint32_t group_size = device().kernel("resolve/accumulate").code().group_size;
    for (const bool alone : {false, true})
        for (const uint32_t count : {3 * group_size, kElements})
        {
            SCOPED_TRACE(testing::Message() << count << (alone ? " alone" : ""));
            CommandTrace trace(device(), alone);
            const std::vector<gpu::vec3> sums = traced(trace, count);
            const uint32_t groups = (count + group_size - 1) / group_size;
            for (uint32_t i = 0; i < kElements; ++i)
                ASSERT_EQ(sums[i].x, i < groups * group_size ? 2 : 1) << i;
            const std::vector<CommandCost>& commands = trace.commands();
            ASSERT_EQ(commands.size(), 4u);
            EXPECT_EQ(commands[0].name, "fill");
            EXPECT_EQ(commands[1].name, "copy");
            EXPECT_EQ(commands[1].scope, "outer");
            EXPECT_EQ(commands[1].bytes, kElements * sizeof(gpu::vec3));
            EXPECT_EQ(commands[2].name, "rays/set_size");
            EXPECT_EQ(commands[2].scope, "inner");
            EXPECT_EQ(commands[2].groups, 1u);
            EXPECT_EQ(commands[3].name, "resolve/accumulate");
            EXPECT_EQ(commands[3].groups, groups);
            EXPECT_EQ(commands[3].bytes, 3 * kElements * sizeof(gpu::vec3) + sizeof(uint32_t));
            for (const CommandCost& cost : commands)
            {
                EXPECT_GE(cost.ms, 0) << cost.name;
                EXPECT_GE(cost.gap_ms, 0) << cost.name;
                EXPECT_GE(cost.cpu_ms, 0) << cost.name;
            }
        }
}

TEST_F(CommandTraceTest, ForgetsTheSubmissionBefore)
{
    CommandTrace trace(device());
    traced(trace, kElements);
    traced(trace, kElements);
    EXPECT_EQ(trace.commands().size(), 4u);
}
} // namespace
