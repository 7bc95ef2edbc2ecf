#include "runtime/gpu/recorder.h"

#include "shaders/lib/queue.h"

#include <algorithm>
#include <array>
#include <ctime>
#include <tuple>

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
    in_order_ = times_scopes_ || trace_;
    schedule_.restart();
    step_ = 0;
    kept_.clear();
    bound_.clear();
    bytes_.clear();
    beginCommands();
    vkCmdResetQueryPool(commands_, queries_, 0, kMaxTimestamps);
    barrier(); // whatever an earlier submission left in flight
    if (!in_order_)
        timestamp();
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
    scopes_.push_back({.name = std::string(name), .first = in_order_ ? timestamp() : 0, .last = 0});
    return Scope(*this);
}

void Recorder::endScope()
{
    if (in_order_)
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
}

uint32_t Recorder::addBytes(const void* bytes, size_t count)
{
    const uint32_t first = uint32_t(bytes_.size());
    const auto* data = static_cast<const std::byte*>(bytes);
    bytes_.insert(bytes_.end(), data, data + count);
    return first;
}

void Recorder::add(Command command, std::string_view name, uint64_t bytes)
{
    if (!in_order_)
    {
        command.step = schedule_.place(accesses_);
        kept_.push_back(command);
    }
    else
    {
        beginTraced();
        command.step = schedule_.place(accesses_, step_);
        if (command.step > step_)
            barrier();
        step_ = command.step;
        startTraced(name, bytes);
        emit(command);
        endTraced(command);
        bound_.clear();
        bytes_.clear();
    }
    accesses_.clear();
}

void Recorder::emitSteps()
{
    std::ranges::stable_sort(kept_, {}, &Command::step);
    for (const Command& command : kept_)
    {
        if (command.step > step_)
            barrier();
        step_ = command.step;
        emit(command);
    }
    kept_.clear();
    bound_.clear();
    bytes_.clear();
    schedule_.restart();
    step_ = 0;
}

void Recorder::emit(const Command& command)
{
    if (command.pipeline)
        emitDispatch(command);
    else if (command.byte_count > 0)
        vkCmdUpdateBuffer(commands_, command.to, command.to_offset, command.byte_count, &bytes_[command.first_byte]);
    else if (command.from)
    {
        const VkBufferCopy region{
            .srcOffset = command.from_offset, .dstOffset = command.to_offset, .size = command.size};
        vkCmdCopyBuffer(commands_, command.from, command.to, 1, &region);
    }
    else
        vkCmdFillBuffer(commands_, command.to, 0, VK_WHOLE_SIZE, command.word);
}

void Recorder::emitDispatch(const Command& command)
{
    std::array<VkDescriptorBufferInfo, 32> infos;
    std::array<VkWriteDescriptorSet, 32> writes;
    for (uint32_t i = 0; i < command.buffer_count; ++i)
    {
        const BoundBuffer& bound = bound_[command.first_buffer + i];
        infos[i] = {.buffer = bound.buffer, .offset = 0, .range = VK_WHOLE_SIZE};
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .dstBinding = bound.binding,
                     .descriptorCount = 1,
                     .descriptorType = bound.type,
                     .pBufferInfo = &infos[i],
                     .pTexelBufferView = &bound.texels};
    }
    vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, command.pipeline);
    if (scene_.set)
        vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, command.layout, 0, 1, &scene_.set, 0,
                                nullptr);
    if (command.buffer_count > 0)
        push_descriptors_(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, command.layout, 1, command.buffer_count,
                          writes.data());
    if (command.byte_count > 0)
        vkCmdPushConstants(commands_, command.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, command.byte_count,
                           &bytes_[command.first_byte]);
    if (command.from)
        vkCmdDispatchIndirect(commands_, command.from, command.from_offset);
    else if (command.groups > 0)
        vkCmdDispatch(commands_, command.groups, 1, 1);
}

VkCommandBuffer Recorder::commands()
{
    emitSteps();
    barrier();
    return commands_;
}

void Recorder::prepare(const Kernel& kernel, const void* params, size_t param_bytes,
                       std::initializer_list<Binding> bindings, const Buffer* arguments)
{
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

    check(bindings.size() <= 32, "{}: {} buffers", code.name, bindings.size());
    prepared_ = {.layout = kernel.layout(),
                 .first_buffer = uint32_t(bound_.size()),
                 .buffer_count = uint32_t(bindings.size()),
                 .first_byte = addBytes(params, param_bytes),
                 .byte_count = uint32_t(param_bytes)};
    prepared_bytes_ = 0;
    for (const uint32_t binding : code.scene_bindings)
    {
        check(binding < scene_.buffers.size(), "{}: it reads binding {} of the scene, of {} given to begin()",
              code.name, binding, scene_.buffers.size());
        note(*scene_.buffers[binding], true, false);
    }
    for (const Binding& binding : bindings)
    {
        const auto block = std::ranges::find(code.blocks, binding.block, &KernelBlock::name);
        check(block != code.blocks.end(), "{}: no block '{}'; its blocks are{}", code.name, binding.block, list());
        check(std::ranges::count(bindings, binding.block, &Binding::block) == 1,
              "{}: block '{}' is given twice; its blocks are{}", code.name, binding.block, list());
        check(!block->texels || binding.buffer.texels(),
              "{}: '{}' is read as texels, but buffer '{}' has no texel view", code.name, binding.block,
              binding.buffer.name());
        note(binding.buffer, block->reads, block->writes);
        bound_.push_back(
            {.binding = block->binding,
             .type = block->texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
             .buffer = binding.buffer.handle(),
             .texels = binding.buffer.texels()});
        prepared_bytes_ += binding.buffer.size();
    }
    if (arguments)
        note(*arguments, true, false);
    prepared_.pipeline = device_.pipeline(kernel); // last: it may have to wait
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

void Recorder::endTraced(const Command& command)
{
    if (!trace_)
        return;
    trace_->timestamps_.back().last = timestamp();
    trace_->commands_.back().pipeline = command.pipeline;
    trace_->commands_.back().groups = command.groups;
    if (trace_->alone_)
    {
        flush();
        trace_->commands_.back().cpu_ms = cpuMs() - cpu_begin_ms_;
    }
    const uint64_t index = trace_->commands_.size() - 1;
    if (!command.pipeline || !command.from || index >= CommandTrace::kMost)
        return;
    const VkBufferCopy region{
        .srcOffset = command.from_offset, .dstOffset = index * sizeof(uint32_t), .size = sizeof(uint32_t)};
    vkCmdCopyBuffer(commands_, command.from, trace_->groups_.handle(), 1, &region);
}

void Recorder::dispatch(const Kernel& kernel, uint32_t thread_count)
{
    const uint32_t groups = (thread_count + kernel.code().group_size - 1) / kernel.code().group_size;
    check(groups <= device_.limits().maxComputeWorkGroupCount[0], "{}: {} groups", kernel.code().name, groups);
    prepared_.groups = groups;
    add(prepared_, kernel.code().name, prepared_bytes_);
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
    prepared_.from = size.handle();
    prepared_.from_offset = offsetof(gpu::QueueSize, groups) + row * sizeof(gpu::uvec3);
    add(prepared_, code.name, prepared_bytes_);
}

void Recorder::fill(const Buffer& buffer, uint32_t word)
{
    note(buffer, false, true);
    add({.to = buffer.handle(), .word = word}, "fill", buffer.size());
}

void Recorder::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t to_offset)
{
    note(from, true, false);
    note(to, false, true);
    add({.from = from.handle(), .to = to.handle(), .to_offset = to_offset, .size = bytes}, "copy", bytes);
}

void Recorder::write(const Buffer& to, uint64_t offset, std::span<const std::byte> bytes)
{
    check(bytes.size() % 4 == 0 && offset + bytes.size() <= to.size(), "{} bytes at {} of {} of {} bytes", bytes.size(),
          offset, to.name(), to.size());
    if (bytes.empty())
        return;
    note(to, false, true);
    Command command{.to = to.handle(), .to_offset = offset};
    if (bytes.size() <= kMostInline)
    {
        command.first_byte = addBytes(bytes.data(), bytes.size());
        command.byte_count = uint32_t(bytes.size());
    }
    else
    {
        std::tie(command.from, command.from_offset) = stage(bytes);
        command.size = bytes.size();
    }
    add(command, "write", bytes.size());
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
    emitSteps();
    if (!in_order_)
        timestamp();
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
    if (!in_order_)
        return {{.name = "frame", .ms = ms.back()}};
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
