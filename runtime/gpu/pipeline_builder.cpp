#include "runtime/gpu/pipeline_builder.h"

#include "runtime/gpu/device.h"

#include <algorithm>
#include <chrono>
#include <system_error>

void PipelineBuilder::build(std::shared_ptr<Kernel::State> state, std::vector<ConstantValue> constants)
{
    std::unique_lock lock(mutex_);
    orders_.push_back({std::move(state), std::move(constants)});
    if (orders_.size() > idle_count_ && threads_.size() < std::max(std::thread::hardware_concurrency(), 1u))
    {
        try
        {
            threads_.emplace_back([this] { work(); });
        }
        catch (const std::system_error&)
        {
            // No more threads to be had: those that run do the work.
        }
    }
    if (threads_.empty())
    {
        const Order order = std::move(orders_.front());
        orders_.pop_front();
        lock.unlock();
        order.state->pipeline = create(order);
        return;
    }
    ordered_.notify_one();
}

VkPipeline PipelineBuilder::wait(const Kernel::State& state)
{
    std::unique_lock lock(mutex_);
    if (!state.pipeline)
    {
        const auto start = std::chrono::steady_clock::now();
        built_.wait(lock, [&] { return state.pipeline != VK_NULL_HANDLE; });
        waited_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    }
    return state.pipeline;
}

void PipelineBuilder::stop()
{
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        orders_.clear();
    }
    ordered_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
    threads_.clear();
}

void PipelineBuilder::work()
{
    std::unique_lock lock(mutex_);
    while (true)
    {
        ++idle_count_;
        ordered_.wait(lock, [&] { return ends_ || !orders_.empty(); });
        --idle_count_;
        if (orders_.empty())
            return;
        const Order order = std::move(orders_.front());
        orders_.pop_front();
        lock.unlock();
        const VkPipeline pipeline = create(order);
        lock.lock();
        order.state->pipeline = pipeline;
        built_.notify_all();
    }
}

VkPipeline PipelineBuilder::create(const Order& order) const
{
    const KernelCode& code = *order.state->code;
    const VkShaderModuleCreateInfo module_info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                               .codeSize = code.words.size_bytes(),
                                               .pCode = code.words.data()};
    VkShaderModule module;
    vulkanCheck(vkCreateShaderModule(device_.handle(), &module_info, nullptr, &module));
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (const auto& [id, value] : order.constants)
    {
        entries.push_back(
            {.constantID = id, .offset = uint32_t(values.size() * sizeof(uint32_t)), .size = sizeof(uint32_t)});
        values.push_back(value);
    }
    const VkSpecializationInfo specialization{.mapEntryCount = uint32_t(entries.size()),
                                              .pMapEntries = entries.data(),
                                              .dataSize = values.size() * sizeof(uint32_t),
                                              .pData = values.data()};
    const VkComputePipelineCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = device_.keepsStatistics() ? VkPipelineCreateFlags(VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR) : 0,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = order.state->layout,
    };
    VkPipeline pipeline;
    vulkanCheck(vkCreateComputePipelines(device_.handle(), cache_, 1, &info, nullptr, &pipeline));
    vkDestroyShaderModule(device_.handle(), module, nullptr);
    device_.nameObject(VK_OBJECT_TYPE_PIPELINE, uint64_t(pipeline), code.name);
    return pipeline;
}
