#include "runtime/gpu/recorder.h"

#include "shaders/lib/queue.h"

#include <algorithm>
#include <array>
#include <ctime>

namespace
{
constexpr uint32_t kMaxTimestamps = 8192; // the reference at its greatest depth takes 6 a vertex
constexpr uint64_t kMostInline = 65536;   // bytes that a command buffer itself takes for a write (vkCmdUpdateBuffer)
constexpr uint64_t kStagingBytes = uint64_t(1) << 20;

double cpuMs()
{
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
}
} // namespace

Recorder::Recorder(const Device& device) : device_(device)
{
    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .queueFamilyIndex = device.queueFamily()};
    vulkanCheck(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_));
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    vulkanCheck(vkAllocateCommandBuffers(device.handle(), &info, &commands_));
    const VkFenceCreateInfo fence{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    vulkanCheck(vkCreateFence(device.handle(), &fence, nullptr, &fence_));
    const VkQueryPoolCreateInfo queries{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = kMaxTimestamps};
    vulkanCheck(vkCreateQueryPool(device.handle(), &queries, nullptr, &queries_));
    push_descriptors_ =
        PFN_vkCmdPushDescriptorSetKHR(vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"));
}

Recorder::~Recorder()
{
    device_.waitIdle();
    vkDestroyQueryPool(device_.handle(), queries_, nullptr);
    vkDestroyFence(device_.handle(), fence_, nullptr);
    vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void Recorder::begin(const SceneSet& scene)
{
    scene_ = scene;
    barrier_count_ = 0;
    scopes_.clear();
    query_count_ = 0;
    staged_.assign(staging_.size(), 0);
    read_.clear();
    written_.clear();
    beginCommands();
    vkCmdResetQueryPool(commands_, queries_, 0, kMaxTimestamps);
    barrier(); // whatever an earlier submission left in flight
    if (trace_)
        trace_->begin();
}

void Recorder::beginCommands()
{
    vulkanCheck(vkResetCommandPool(device_.handle(), pool_, 0));
    const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    vulkanCheck(vkBeginCommandBuffer(commands_, &info));
}

uint32_t Recorder::timestamp()
{
    // A submission of very many scopes times the first of them; what comes after the pool is full counts nothing.
    if (query_count_ == kMaxTimestamps)
        return query_count_ - 1;
    vkCmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_, query_count_);
    return query_count_++;
}

Recorder::Scope Recorder::scope(std::string_view name)
{
    open_scopes_.push_back(scopes_.size());
    scopes_.push_back({.name = std::string(name), .first = timestamp(), .last = 0});
    return Scope(*this);
}

void Recorder::endScope()
{
    scopes_[open_scopes_.back()].last = timestamp();
    open_scopes_.pop_back();
}

void Recorder::barrier()
{
    constexpr VkPipelineStageFlags2 kStages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT |
                                              VK_PIPELINE_STAGE_2_TRANSFER_BIT | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
    const VkMemoryBarrier2 memory{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = kStages,
        .srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .dstStageMask = kStages,
        .dstAccessMask = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT |
                         VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT |
                         VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
    };
    const VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &memory};
    vkCmdPipelineBarrier2(commands_, &info);
    ++barrier_count_;
    read_.clear();
    written_.clear();
}

bool Recorder::conflicts(const Buffer& buffer, bool writes) const
{
    const auto overlaps = [range = buffer.range()](const MemoryRange& other) { return range.overlaps(other); };
    return std::ranges::any_of(written_, overlaps) || (writes && std::ranges::any_of(read_, overlaps));
}

void Recorder::note(const Buffer& buffer, bool reads, bool writes)
{
    const auto add = [range = buffer.range()](std::vector<MemoryRange>& to)
    {
        if (std::ranges::find(to, range) == to.end())
            to.push_back(range);
    };
    if (reads)
        add(read_);
    if (writes)
        add(written_);
}

void Recorder::prepare(const Kernel& kernel, const void* params, size_t param_bytes,
                       std::initializer_list<Binding> bindings, const Buffer* arguments)
{
    beginTraced();
    const KernelCode& code = kernel.code();
    check(param_bytes == code.push_bytes, "{}: {} bytes of parameters given, the kernel has {}", code.name, param_bytes,
          code.push_bytes);
    const auto list = [&]
    {
        std::string names;
        for (const KernelBlock& block : code.blocks)
            names += fmt::format(" {}", block.name);
        return names;
    };
    check(bindings.size() == code.blocks.size(), "{}: {} buffers given, the kernel's blocks are{}", code.name,
          bindings.size(), list());

    std::array<VkDescriptorBufferInfo, 32> infos;
    std::array<VkWriteDescriptorSet, 32> writes;
    uint32_t count = 0;
    bool hazard = arguments && conflicts(*arguments, false);
    for (const uint32_t binding : code.scene_bindings)
    {
        check(binding < scene_.buffers.size(), "{}: it reads binding {} of the scene, of {} given to begin()",
              code.name, binding, scene_.buffers.size());
        hazard |= conflicts(*scene_.buffers[binding], false);
    }
    for (const Binding& binding : bindings)
    {
        const auto block = std::ranges::find(code.blocks, binding.block, &KernelBlock::name);
        check(block != code.blocks.end(), "{}: no block '{}'; its blocks are{}", code.name, binding.block, list());
        check(std::ranges::count(bindings, binding.block, &Binding::block) == 1,
              "{}: block '{}' is given twice; its blocks are{}", code.name, binding.block, list());
        hazard |= conflicts(binding.buffer, block->writes);
        check(!block->texels || binding.buffer.texels(),
              "{}: '{}' is read as texels, but buffer '{}' has no texel view", code.name, binding.block,
              binding.buffer.name());
        infos[count] = {.buffer = binding.buffer.handle(), .offset = 0, .range = VK_WHOLE_SIZE};
        writes[count] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                         .dstBinding = block->binding,
                         .descriptorCount = 1,
                         .descriptorType = block->texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                                         : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                         .pBufferInfo = &infos[count],
                         .pTexelBufferView = &binding.buffer.texels()};
        ++count;
    }
    if (hazard)
        barrier();
    for (const Binding& binding : bindings)
    {
        const auto block = std::ranges::find(code.blocks, binding.block, &KernelBlock::name);
        note(binding.buffer, block->reads, block->writes);
    }
    for (const uint32_t binding : code.scene_bindings)
        note(*scene_.buffers[binding], true, false);
    if (arguments)
        note(*arguments, true, false);

    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.pipeline());
    if (scene_.set)
        vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 0, 1, &scene_.set, 0,
                                nullptr);
    if (count > 0)
        push_descriptors_(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, kernel.layout(), 1, count, writes.data());
    if (param_bytes > 0)
        vkCmdPushConstants(commands_, kernel.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, uint32_t(param_bytes), params);
    uint64_t bytes = 0;
    for (const Binding& binding : bindings)
        bytes += binding.buffer.size();
    startTraced(code.name, bytes);
}

void Recorder::flush()
{
    vulkanCheck(vkEndCommandBuffer(commands_));
    vulkanCheck(vkResetFences(device_.handle(), 1, &fence_));
    const VkSubmitInfo info{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_};
    vulkanCheck(vkQueueSubmit(device_.queue(), 1, &info, fence_));
    vulkanCheck(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX));
    beginCommands();
}

void Recorder::beginTraced()
{
    if (!trace_ || !trace_->alone_)
        return;
    flush();
    cpu_begin_ms_ = cpuMs();
}

void Recorder::startTraced(std::string_view name, uint64_t bytes)
{
    if (trace_)
        trace_->add(name, scopeName(), bytes, timestamp());
}

void Recorder::endTraced(uint32_t groups, const Buffer* size, uint64_t offset)
{
    if (!trace_)
        return;
    trace_->timestamps_.back().last = timestamp();
    trace_->commands_.back().groups = groups;
    if (trace_->alone_)
    {
        flush();
        trace_->commands_.back().cpu_ms = cpuMs() - cpu_begin_ms_;
    }
    const uint64_t index = trace_->commands_.size() - 1;
    if (!size || index >= CommandTrace::kMost)
        return;
    const VkBufferCopy region{.srcOffset = offset, .dstOffset = index * sizeof(uint32_t), .size = sizeof(uint32_t)};
    vkCmdCopyBuffer(commands_, size->handle(), trace_->groups_.handle(), 1, &region);
}

void Recorder::dispatch(const Kernel& kernel, uint32_t thread_count)
{
    const uint32_t groups = (thread_count + kernel.code().group_size - 1) / kernel.code().group_size;
    check(groups <= device_.limits().maxComputeWorkGroupCount[0], "{}: {} groups", kernel.code().name, groups);
    if (groups > 0)
        vkCmdDispatch(commands_, groups, 1, 1);
    endTraced(groups);
}

void Recorder::dispatchIndirect(const Kernel& kernel, const Buffer& size)
{
    const KernelCode& code = kernel.code();
    check(size.size() >= sizeof(gpu::QueueSize), "{}: buffer '{}' of {} bytes is no QueueSize", code.name, size.name(),
          size.size());
    uint32_t row = 0;
    while (row < gpu::kQueueRows && gpu::queueGroupSize(row) != code.group_size)
        ++row;
    check(row < gpu::kQueueRows, "{}: a QueueSize has no dispatch for groups of {} threads", code.name,
          code.group_size);
    const uint64_t offset = offsetof(gpu::QueueSize, groups) + row * sizeof(gpu::uvec3);
    vkCmdDispatchIndirect(commands_, size.handle(), offset);
    endTraced(0, &size, offset);
}

void Recorder::fill(const Buffer& buffer, uint32_t word)
{
    beginTraced();
    if (conflicts(buffer, true))
        barrier();
    note(buffer, false, true);
    startTraced("fill", buffer.size());
    vkCmdFillBuffer(commands_, buffer.handle(), 0, VK_WHOLE_SIZE, word);
    endTraced(0);
}

void Recorder::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t to_offset)
{
    beginTraced();
    if (conflicts(from, false) || conflicts(to, true))
        barrier();
    note(from, true, false);
    note(to, false, true);
    startTraced("copy", bytes);
    const VkBufferCopy region{.dstOffset = to_offset, .size = bytes};
    vkCmdCopyBuffer(commands_, from.handle(), to.handle(), 1, &region);
    endTraced(0);
}

void Recorder::write(const Buffer& to, uint64_t offset, std::span<const std::byte> bytes)
{
    check(bytes.size() % 4 == 0 && offset + bytes.size() <= to.size(), "{} bytes at {} of {} of {} bytes", bytes.size(),
          offset, to.name(), to.size());
    if (bytes.empty())
        return;
    beginTraced();
    if (conflicts(to, true))
        barrier();
    note(to, false, true);
    startTraced("write", bytes.size());
    if (bytes.size() <= kMostInline)
        vkCmdUpdateBuffer(commands_, to.handle(), offset, bytes.size(), bytes.data());
    else
    {
        const auto [from, from_offset] = stage(bytes);
        const VkBufferCopy region{.srcOffset = from_offset, .dstOffset = offset, .size = bytes.size()};
        vkCmdCopyBuffer(commands_, from, to.handle(), 1, &region);
    }
    endTraced(0);
}

std::pair<VkBuffer, uint64_t> Recorder::stage(std::span<const std::byte> bytes)
{
    size_t i = 0;
    while (i < staging_.size() && staged_[i] + bytes.size() > staging_[i].size())
        ++i;
    if (i == staging_.size())
    {
        staging_.push_back(device_.stagingBuffer("recorder.staging", std::max<uint64_t>(bytes.size(), kStagingBytes)));
        staged_.push_back(0);
    }
    const uint64_t offset = staged_[i];
    std::ranges::copy(bytes, staging_[i].mapped().begin() + ptrdiff_t(offset));
    staged_[i] += bytes.size();
    return {staging_[i].handle(), offset};
}

void Recorder::submit(VkSemaphore wait_for, VkSemaphore signal)
{
    check(open_scopes_.empty(), "scope '{}' is still open", scopes_[open_scopes_.back()].name);
    const VkMemoryBarrier2 to_host{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT,
        .dstAccessMask = VK_ACCESS_2_HOST_READ_BIT,
    };
    const VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &to_host};
    vkCmdPipelineBarrier2(commands_, &info);
    vulkanCheck(vkEndCommandBuffer(commands_));
    vulkanCheck(vkResetFences(device_.handle(), 1, &fence_));
    constexpr VkPipelineStageFlags kWaitStage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkSubmitInfo submit_info{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = wait_for ? 1u : 0u,
        .pWaitSemaphores = &wait_for,
        .pWaitDstStageMask = &kWaitStage,
        .commandBufferCount = 1,
        .pCommandBuffers = &commands_,
        .signalSemaphoreCount = signal ? 1u : 0u,
        .pSignalSemaphores = &signal,
    };
    vulkanCheck(vkQueueSubmit(device_.queue(), 1, &submit_info, fence_));
}

std::vector<StageTime> Recorder::wait()
{
    vulkanCheck(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX));
    std::vector<uint64_t> ticks(query_count_);
    if (query_count_ > 0)
        vulkanCheck(vkGetQueryPoolResults(device_.handle(), queries_, 0, query_count_, ticks.size() * sizeof(uint64_t),
                                          ticks.data(), sizeof(uint64_t),
                                          VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT));
    std::vector<double> ms;
    for (const uint64_t tick : ticks)
        ms.push_back(double(tick - ticks[0]) * device_.limits().timestampPeriod * 1e-6);
    if (trace_)
        trace_->end(ms);
    std::vector<StageTime> times;
    for (const ScopeRecord& record : scopes_)
    {
        auto entry = std::ranges::find(times, record.name, &StageTime::name);
        if (entry == times.end())
            entry = times.insert(times.end(), StageTime{.name = record.name});
        entry->ms += ms[record.last] - ms[record.first];
    }
    return times;
}

std::vector<StageTime> Recorder::submitAndWait()
{
    submit(VK_NULL_HANDLE, VK_NULL_HANDLE);
    return wait();
}
