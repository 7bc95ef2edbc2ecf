// Pipelines that threads build: each kernel gets its own, and a device may be closed at any time.
#include "tests/stages/gpu_test.h"

#include <array>
#include <set>

namespace
{
/// A device of the test's own, whose kernels no other test has asked for. The validation layers end the process where it leaves anything
/// behind when it is closed.
std::unique_ptr<Device> newDevice()
{
    const auto instance = Instance::create({.validation = true});
    check(bool(instance), "{}", instance ? "" : instance.error().message);
    const auto index = selectDevice(instance->devices(), "");
    check(bool(index), "{}", index ? "" : index.error().message);
    auto device = Device::create(*instance, *index);
    check(bool(device), "{}", device ? "" : device.error().message);
    return std::move(*device);
}

class PipelineBuilderTest : public GpuTest
{
};

TEST_F(PipelineBuilderTest, GivesEachKernelAPipelineInWhateverOrderTheyAreWaitedFor)
{
    const auto device = newDevice();
    constexpr std::array<std::string_view, 5> kNames{"resolve/tonemap", "rays/set_size", "primitives/sum",
                                                     "resolve/accumulate", "samples/points"};
    std::vector<Kernel> kernels;
    for (const std::string_view name : kNames)
        kernels.push_back(device->kernel(name));
    EXPECT_EQ(device->pipelineCount(), kNames.size());
    std::set<VkPipeline> pipelines;
    for (size_t i = kNames.size(); i-- > 0;)
        pipelines.insert(device->pipeline(kernels[i]));
    EXPECT_EQ(pipelines.size(), kNames.size());
    EXPECT_FALSE(pipelines.contains(VK_NULL_HANDLE));
    EXPECT_EQ(device->pipeline(device->kernel(kNames[0])), device->pipeline(kernels[0]));
    EXPECT_EQ(device->pipelineCount(), kNames.size());
}

TEST_F(PipelineBuilderTest, MayBeClosedWhilePipelinesAreBuilt)
{
    for (const bool waits : {false, true})
    {
        const auto device = newDevice();
        const Kernel first = device->kernel("resolve/tonemap");
        for (const KernelCode& code : kernelCodes())
            (void)device->kernel(code.name);
        if (waits)
        {
            EXPECT_NE(device->pipeline(first), VkPipeline(VK_NULL_HANDLE));
        }
    }
}
} // namespace
