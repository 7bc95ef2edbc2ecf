#include "runtime/gpu/device.h"

#include "format/block_texture.h"
#include "format/gpu_scene.h"
#include "runtime/gpu/cache_folder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <iterator>

namespace
{
constexpr uint64_t kStagingBytes = uint64_t(16) << 20;
} // namespace

Result<std::unique_ptr<Device>> Device::create(const Instance& instance, uint32_t index, bool present)
{
    std::unique_ptr<Device> device(new Device);
    device->instance_ = instance;
    device->physical_ = instance.physicalDevice(index);
    vkGetPhysicalDeviceProperties(device->physical_, &device->properties_);
    vkGetPhysicalDeviceMemoryProperties(device->physical_, &device->memory_);

    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device->physical_, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device->physical_, &count, families.data());
    const auto family = std::ranges::find_if(families,
                                             [](const auto& f)
                                             {
                                                 constexpr VkQueueFlags kNeeds =
                                                     VK_QUEUE_COMPUTE_BIT | VK_QUEUE_GRAPHICS_BIT;
                                                 return (f.queueFlags & kNeeds) == kNeeds && f.timestampValidBits > 0;
                                             });
    if (family == families.end())
        return Error{ExitCode::kDevice,
                     fmt::format("{} has no queue for graphics, compute and timestamps", device->name())};
    device->queue_family_ = uint32_t(family - families.begin());

    constexpr float kPriority = 1;
    const VkDeviceQueueCreateInfo queue{
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = device->queue_family_,
        .queueCount = 1,
        .pQueuePriorities = &kPriority,
    };
    VkPhysicalDeviceVulkan13Features f13{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .synchronization2 = VK_TRUE,
        .maintenance4 = VK_TRUE,
    };
    VkPhysicalDeviceVulkan12Features f12{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &f13, .scalarBlockLayout = VK_TRUE};
    VkPhysicalDeviceFeatures offered;
    vkGetPhysicalDeviceFeatures(device->physical_, &offered);
    device->samples_blocks_ = offered.textureCompressionBC == VK_TRUE && !device->isCpu();
    const VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                             .pNext = &f12,
                                             .features = {.textureCompressionBC = offered.textureCompressionBC}};
    std::vector<const char*> extensions{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    if (present)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const VkDeviceCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = uint32_t(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    if (const VkResult result = vkCreateDevice(device->physical_, &info, nullptr, &device->device_);
        result != VK_SUCCESS)
        return Error{ExitCode::kDevice,
                     fmt::format("{} cannot be opened ({})", device->name(), vulkanResultName(result))};
    vkGetDeviceQueue(device->device_, device->queue_family_, 0, &device->queue_);
    device->set_name_ =
        PFN_vkSetDebugUtilsObjectNameEXT(vkGetInstanceProcAddr(instance.handle(), "vkSetDebugUtilsObjectNameEXT"));
    device->createLayouts();
    device->loadPipelineCache();
    return device;
}

void Device::createLayouts()
{
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    const auto add = [&](uint32_t binding, VkDescriptorType type, uint32_t count)
    {
        bindings.push_back({.binding = binding,
                            .descriptorType = type,
                            .descriptorCount = count,
                            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
    };
    add(gpu::kSceneInfoBinding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1);
    for (uint32_t b = gpu::kBvhNodesBinding; b <= gpu::kLightsBinding; ++b)
        add(b, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 1);
    for (uint32_t b = gpu::kTextureRefsBinding; b <= gpu::kViewScaleBinding; ++b)
        add(b, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1);
    add(gpu::kTexturePagesBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, gpu::kTexturePageCount);
    add(gpu::kEnvironmentMapBinding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1);
    const VkDescriptorSetLayoutCreateInfo layout{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = uint32_t(bindings.size()),
        .pBindings = bindings.data(),
    };
    vulkanCheck(vkCreateDescriptorSetLayout(device_, &layout, nullptr, &scene_set_layout_));

    const VkCommandPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                       .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                       .queueFamilyIndex = queue_family_};
    vulkanCheck(vkCreateCommandPool(device_, &pool, nullptr, &once_pool_));
}

Device::~Device()
{
    if (!device_)
        return;
    waitIdle();
    staging_ = {};
    kernels_.clear();
    savePipelineCache();
    vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
    vkDestroyCommandPool(device_, once_pool_, nullptr);
    vkDestroyDescriptorSetLayout(device_, scene_set_layout_, nullptr);
    vkDestroyDevice(device_, nullptr);
}

void Device::nameObject(VkObjectType type, uint64_t handle, std::string_view name) const
{
    if (!set_name_)
        return;
    const std::string text(name);
    const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                             .objectType = type,
                                             .objectHandle = handle,
                                             .pObjectName = text.c_str()};
    set_name_(device_, &info);
}

// ---- Pipelines -----------------------------------------------------------------------------------------------------

void Device::loadPipelineCache()
{
    std::vector<char> data;
    if (const auto folder = cacheFolder())
    {
        pipeline_cache_path_ = *folder / fmt::format("pipelines-{:04x}-{:04x}-{:08x}.bin", properties_.vendorID,
                                                     properties_.deviceID, properties_.driverVersion);
        std::ifstream file(pipeline_cache_path_, std::ios::binary);
        data.assign(std::istreambuf_iterator<char>(file), {});
    }
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                         .initialDataSize = data.size(),
                                         .pInitialData = data.data()};
    vulkanCheck(vkCreatePipelineCache(device_, &info, nullptr, &pipeline_cache_));
}

void Device::savePipelineCache() const
{
    size_t bytes = 0;
    if (pipeline_cache_path_.empty() || vkGetPipelineCacheData(device_, pipeline_cache_, &bytes, nullptr) != VK_SUCCESS)
        return;
    std::vector<char> data(bytes);
    if (vkGetPipelineCacheData(device_, pipeline_cache_, &bytes, data.data()) != VK_SUCCESS)
        return;
    // A cache is a convenience: a folder that cannot be written costs start-up time, nothing else.
    std::error_code ignored;
    std::filesystem::create_directories(pipeline_cache_path_.parent_path(), ignored);
    const auto temporary = pipeline_cache_path_.string() + fmt::format(".{:016x}.tmp", uint64_t(uintptr_t(device_)));
    std::ofstream(temporary, std::ios::binary).write(data.data(), std::streamsize(bytes));
    std::filesystem::rename(temporary, pipeline_cache_path_, ignored);
}

Kernel::State::~State()
{
    vkDestroyPipeline(device, pipeline, nullptr);
    vkDestroyPipelineLayout(device, layout, nullptr);
    vkDestroyDescriptorSetLayout(device, set_layout, nullptr);
}

std::vector<Device::ConstantValue> Device::constantValues(const KernelCode& code, const SharedConstants& shared,
                                                          std::initializer_list<Constant> constants)
{
    const auto find = [](const KernelCode& in, std::string_view name)
    { return std::ranges::find(in.constants, name, &KernelConstant::name); };
    std::vector<ConstantValue> values;
    for (const Constant& constant : constants)
    {
        const auto found = find(code, constant.name);
        check(found != code.constants.end(), "{}: it uses no specialization constant '{}'", code.name, constant.name);
        values.emplace_back(found->id, constant.value);
    }
    for (const Constant& constant : shared.list)
    {
        const auto found = find(code, constant.name);
        if (found != code.constants.end())
            values.emplace_back(found->id, constant.value);
        else
            check(std::ranges::any_of(kernelCodes(), [&](const KernelCode& other)
                                      { return find(other, constant.name) != other.constants.end(); }),
                  "no kernel uses a specialization constant '{}'", constant.name);
    }
    std::ranges::sort(values);
    check(std::ranges::adjacent_find(values, {}, &ConstantValue::first) == values.end(),
          "{}: a specialization constant is given twice", code.name);
    return values;
}

Kernel Device::kernel(std::string_view name, const SharedConstants& shared,
                      std::initializer_list<Constant> constants) const
{
    const auto codes = kernelCodes();
    const auto code = std::ranges::find(codes, name, &KernelCode::name);
    check(code != codes.end(), "there is no kernel '{}'", name);
    return kernel(*code, shared, constants);
}

Kernel Device::kernel(const KernelCode& code, const SharedConstants& shared,
                      std::initializer_list<Constant> constants) const
{
    const std::vector<ConstantValue> values = constantValues(code, shared, constants);
    const auto [entry, added] = kernels_.try_emplace({std::string(code.name), values});
    if (added)
        entry->second = createKernel(code, values);
    return entry->second;
}

Kernel Device::createKernel(const KernelCode& code, std::span<const ConstantValue> constants) const
{
    Kernel kernel;
    kernel.state_ = std::make_shared<Kernel::State>();
    Kernel::State& state = *kernel.state_;
    state.device = device_;
    state.code = &code;

    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const KernelBlock& block : code.blocks)
        bindings.push_back({.binding = block.binding,
                            .descriptorType = block.texels ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                                           : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                            .descriptorCount = 1,
                            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
    const VkDescriptorSetLayoutCreateInfo set_info{
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR,
        .bindingCount = uint32_t(bindings.size()),
        .pBindings = bindings.data(),
    };
    vulkanCheck(vkCreateDescriptorSetLayout(device_, &set_info, nullptr, &state.set_layout));
    const std::array sets{scene_set_layout_, state.set_layout};
    const VkPushConstantRange push{.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT, .size = code.push_bytes};
    const VkPipelineLayoutCreateInfo layout_info{
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = uint32_t(sets.size()),
        .pSetLayouts = sets.data(),
        .pushConstantRangeCount = code.push_bytes > 0 ? 1u : 0u,
        .pPushConstantRanges = &push,
    };
    vulkanCheck(vkCreatePipelineLayout(device_, &layout_info, nullptr, &state.layout));

    const auto start = std::chrono::steady_clock::now();
    const VkShaderModuleCreateInfo module_info{.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                               .codeSize = code.words.size_bytes(),
                                               .pCode = code.words.data()};
    VkShaderModule module;
    vulkanCheck(vkCreateShaderModule(device_, &module_info, nullptr, &module));
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (const auto& [id, value] : constants)
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
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialization},
        .layout = state.layout,
    };
    vulkanCheck(vkCreateComputePipelines(device_, pipeline_cache_, 1, &info, nullptr, &state.pipeline));
    vkDestroyShaderModule(device_, module, nullptr);
    nameObject(VK_OBJECT_TYPE_PIPELINE, uint64_t(state.pipeline), code.name);
    pipeline_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return kernel;
}

// ---- Memory --------------------------------------------------------------------------------------------------------

VkDeviceMemory Device::allocate(const VkMemoryRequirements& needs, Placement placement, bool& host_visible) const
{
    constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    constexpr VkMemoryPropertyFlags kVisible =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    // First choice, then what also works.
    const std::array<VkMemoryPropertyFlags, 2> wishes =
        placement == Placement::kDevice     ? std::array{kLocal, VkMemoryPropertyFlags(0)}
        : placement == Placement::kReadback ? std::array{kVisible | kCached, kVisible}
                                            : std::array{kVisible, kVisible};
    for (const VkMemoryPropertyFlags wish : wishes)
        for (uint32_t type = 0; type < memory_.memoryTypeCount; ++type)
        {
            const VkMemoryPropertyFlags flags = memory_.memoryTypes[type].propertyFlags;
            if (!(needs.memoryTypeBits & (1u << type)) || (flags & wish) != wish)
                continue;
            const VkMemoryAllocateInfo info{
                .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = needs.size, .memoryTypeIndex = type};
            VkDeviceMemory memory = VK_NULL_HANDLE;
            if (vkAllocateMemory(device_, &info, nullptr, &memory) != VK_SUCCESS)
                continue;
            // Large device-local memory of a discrete GPU may be mappable too; only CPU-side devices gain by mapping it.
            host_visible = (flags & kVisible) == kVisible && (placement != Placement::kDevice || isCpu());
            allocated_bytes_ += needs.size;
            return memory;
        }
    return VK_NULL_HANDLE;
}

template <typename Record>
void Device::submitOnce(Record&& record) const
{
    const VkCommandBufferAllocateInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                           .commandPool = once_pool_,
                                           .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                           .commandBufferCount = 1};
    VkCommandBuffer commands;
    vulkanCheck(vkAllocateCommandBuffers(device_, &info, &commands));
    const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                         .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    vulkanCheck(vkBeginCommandBuffer(commands, &begin));
    record(commands);
    vulkanCheck(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit{
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    vulkanCheck(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE));
    vulkanCheck(vkQueueWaitIdle(queue_));
    vkFreeCommandBuffers(device_, once_pool_, 1, &commands);
}

Buffer Device::buffer(std::string_view name, uint64_t bytes, Placement placement) const
{
    Buffer buffer;
    buffer.device_ = device_;
    buffer.size_ = bytes;
    buffer.name_ = name;
    const VkBufferCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = bytes,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    vulkanCheck(vkCreateBuffer(device_, &info, nullptr, &buffer.buffer_));
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device_, buffer.buffer_, &needs);
    bool host_visible = false;
    buffer.memory_ = allocate(needs, placement, host_visible);
    check(buffer.memory_ != VK_NULL_HANDLE, "out of device memory: buffer '{}' of {} bytes", name, bytes);
    vulkanCheck(vkBindBufferMemory(device_, buffer.buffer_, buffer.memory_, 0));
    if (host_visible)
    {
        void* pointer = nullptr;
        vulkanCheck(vkMapMemory(device_, buffer.memory_, 0, VK_WHOLE_SIZE, 0, &pointer));
        buffer.mapped_ = {static_cast<std::byte*>(pointer), size_t(bytes)};
    }
    nameObject(VK_OBJECT_TYPE_BUFFER, uint64_t(buffer.buffer_), name);
    if (instance_.validates() && placement == Placement::kDevice)
        submitOnce([&](VkCommandBuffer commands)
                   { vkCmdFillBuffer(commands, buffer.handle(), 0, VK_WHOLE_SIZE, kUnwritten); });
    return buffer;
}

Buffer Device::withTexels(Buffer buffer) const
{
    check(buffer.size() / kTexelBytes <= limits().maxTexelBufferElements,
          "buffer '{}' of {} bytes has more than {} texels", buffer.name(), buffer.size(),
          limits().maxTexelBufferElements);
    const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                      .buffer = buffer.handle(),
                                      .format = VK_FORMAT_R32G32B32A32_UINT,
                                      .range = VK_WHOLE_SIZE};
    vulkanCheck(vkCreateBufferView(device_, &info, nullptr, &buffer.texels_));
    return buffer;
}

const Buffer& Device::staging(uint64_t bytes) const
{
    if (staging_.size() < bytes)
    {
        staging_ = {}; // before the next, so that there is never more than one
        staging_ = buffer("staging", std::max(bytes, kStagingBytes), Placement::kStaging);
    }
    return staging_;
}

Buffer Device::uploadBytes(std::string_view name, std::span<const std::byte> data) const
{
    Buffer target = buffer(name, std::max<size_t>(data.size(), 16), Placement::kDevice);
    if (!target.mapped().empty())
    {
        std::memcpy(target.mapped().data(), data.data(), data.size());
        return target;
    }
    for (uint64_t begin = 0; begin < data.size(); begin += kStagingBytes)
    {
        const VkBufferCopy copy{.dstOffset = begin, .size = std::min(data.size() - begin, kStagingBytes)};
        const Buffer& from = staging(copy.size);
        std::memcpy(from.mapped().data(), data.data() + begin, copy.size);
        submitOnce([&](VkCommandBuffer commands)
                   { vkCmdCopyBuffer(commands, from.handle(), target.handle(), 1, &copy); });
    }
    return target;
}

void Device::downloadBytes(const Buffer& source, std::span<std::byte> data) const
{
    check(data.size() <= source.size(), "{}: {} bytes asked of {}", source.name(), data.size(), source.size());
    const Buffer staging = readback("download", std::max<size_t>(data.size(), 1));
    submitOnce(
        [&](VkCommandBuffer commands)
        {
            const VkMemoryBarrier before{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                         .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                         .dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT};
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1,
                                 &before, 0, nullptr, 0, nullptr);
            const VkBufferCopy copy{.size = data.size()};
            vkCmdCopyBuffer(commands, source.handle(), staging.handle(), 1, &copy);
            const VkMemoryBarrier after{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
                                        .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                        .dstAccessMask = VK_ACCESS_HOST_READ_BIT};
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &after, 0,
                                 nullptr, 0, nullptr);
        });
    std::memcpy(data.data(), staging.mapped().data(), data.size());
}

namespace
{
void transition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to, VkAccessFlags2 wrote,
                VkAccessFlags2 reads, VkPipelineStageFlags2 before, VkPipelineStageFlags2 after)
{
    const VkImageMemoryBarrier2 barrier{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = before,
        .srcAccessMask = wrote,
        .dstStageMask = after,
        .dstAccessMask = reads,
        .oldLayout = from,
        .newLayout = to,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS},
    };
    const VkDependencyInfo info{
        .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
    vkCmdPipelineBarrier2(commands, &info);
}

/// Of one layer of one level: whole blocks, where the format has them.
uint64_t levelBytes(VkFormat format, uint32_t width, uint32_t height)
{
    switch (format)
    {
    case VK_FORMAT_BC4_UNORM_BLOCK:
        return 8 * blocks::countIn(width, height);
    case VK_FORMAT_BC5_UNORM_BLOCK:
    case VK_FORMAT_BC7_UNORM_BLOCK:
    case VK_FORMAT_BC7_SRGB_BLOCK:
        return 16 * blocks::countIn(width, height);
    case VK_FORMAT_R32G32B32A32_SFLOAT:
        return uint64_t(16) * width * height;
    default:
        return uint64_t(4) * width * height;
    }
}
} // namespace

Image Device::uploadImage(std::string_view name, const ImageShape& shape, std::span<const std::byte> data) const
{
    Image image;
    image.device_ = device_;
    const VkImageCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = shape.format,
        .extent = {shape.width, shape.height, 1},
        .mipLevels = shape.levels,
        .arrayLayers = shape.layers,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT, // tests read back
    };
    vulkanCheck(vkCreateImage(device_, &info, nullptr, &image.image_));
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device_, image.image_, &needs);
    bool host_visible = false;
    image.memory_ = allocate(needs, Placement::kDevice, host_visible);
    check(image.memory_ != VK_NULL_HANDLE, "out of device memory: image '{}' of {} bytes", name, needs.size);
    vulkanCheck(vkBindImageMemory(device_, image.image_, image.memory_, 0));
    nameObject(VK_OBJECT_TYPE_IMAGE, uint64_t(image.image_), name);

    uint64_t offset = 0; // of what has been copied
    const auto copy = [&](std::span<const VkBufferImageCopy> copies, uint64_t bytes, bool last)
    {
        check(offset + bytes <= data.size(), "image '{}' needs more than {} bytes", name, data.size());
        const Buffer& from = staging(bytes);
        std::memcpy(from.mapped().data(), data.data() + offset, bytes);
        submitOnce(
            [&](VkCommandBuffer commands)
            {
                if (offset == 0)
                    transition(commands, image.image_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               0, VK_ACCESS_2_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_2_NONE,
                               VK_PIPELINE_STAGE_2_TRANSFER_BIT);
                vkCmdCopyBufferToImage(commands, from.handle(), image.image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                       uint32_t(copies.size()), copies.data());
                if (last)
                    transition(commands, image.image_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                               VK_ACCESS_2_SHADER_READ_BIT, VK_PIPELINE_STAGE_2_TRANSFER_BIT,
                               VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
            });
        offset += bytes;
    };
    std::vector<VkBufferImageCopy> copies; // what still fits into one go
    uint64_t bytes = 0;
    for (uint32_t level = 0; level < shape.levels; ++level)
    {
        const uint32_t width = std::max(shape.width >> level, 1u), height = std::max(shape.height >> level, 1u);
        for (uint32_t layer = 0; layer < shape.layers; ++layer)
        {
            const uint64_t layer_bytes = levelBytes(shape.format, width, height);
            if (bytes > 0 && bytes + layer_bytes > kStagingBytes)
            {
                copy(copies, bytes, false);
                copies.clear();
                bytes = 0;
            }
            copies.push_back({.bufferOffset = bytes,
                              .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, layer, 1},
                              .imageExtent = {width, height, 1}});
            bytes += layer_bytes;
        }
    }
    copy(copies, bytes, true);
    check(offset == data.size(), "image '{}' needs {} bytes, not {}", name, offset, data.size());
    if (staging_.size() > kStagingBytes) // a layer was larger than that
        staging_ = {};

    const VkImageViewCreateInfo view{
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = image.image_,
        .viewType = shape.array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
        .format = shape.format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, shape.levels, 0, shape.layers},
    };
    vulkanCheck(vkCreateImageView(device_, &view, nullptr, &image.view_));
    return image;
}
