#include "runtime/gpu/device.h"

#include "format/gpu_scene.h"
#include "format/temporary_file.h"
#include "runtime/gpu/cache_folder.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

Result<std::unique_ptr<Device>> Device::create(const Instance& instance, uint32_t index, const DeviceUse& use)
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
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR,
        .pNext = &f12,
        .pipelineExecutableInfo = VK_TRUE};
    device->keeps_statistics_ = use.kernel_statistics && instance.devices()[index].tells_statistics;
    const VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                             .pNext =
                                                 device->keeps_statistics_ ? static_cast<void*>(&statistics) : &f12,
                                             .features = {.textureCompressionBC = offered.textureCompressionBC}};
    std::vector<const char*> extensions{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
    if (device->keeps_statistics_)
        extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    if (use.present)
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
        return Error{isDeviceFailure(result) ? kTryAgain : ExitCode::kDevice,
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
    pipelines_.reset(); // before anything that its threads use
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

namespace
{
std::vector<char> fileContent(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Nothing where the driver has no room for it.
std::vector<char> cacheData(VkDevice device, VkPipelineCache cache)
{
    size_t byte_count = 0;
    std::vector<char> data;
    if (vkGetPipelineCacheData(device, cache, &byte_count, nullptr) != VK_SUCCESS)
        return data;
    data.resize(byte_count);
    if (vkGetPipelineCacheData(device, cache, &byte_count, data.data()) != VK_SUCCESS)
        data.clear();
    return data;
}
} // namespace

VkPipelineCache Device::pipelineCacheOf(std::span<const char> data) const
{
    const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                         .initialDataSize = data.size(),
                                         .pInitialData = data.data()};
    VkPipelineCache cache = VK_NULL_HANDLE;
    vulkanCheck(vkCreatePipelineCache(device_, &info, nullptr, &cache));
    return cache;
}

void Device::loadPipelineCache()
{
    std::vector<char> data;
    if (const auto folder = cacheFolder())
    {
        pipeline_cache_path_ = *folder / fmt::format("pipelines-{:04x}-{:04x}-{:08x}.bin", properties_.vendorID,
                                                     properties_.deviceID, properties_.driverVersion);
        data = fileContent(pipeline_cache_path_);
    }
    pipeline_cache_ = pipelineCacheOf(data);
    pipeline_cache_bytes_ = data.empty() ? 0 : cacheData(device_, pipeline_cache_).size();
    pipelines_ = std::make_unique<PipelineBuilder>(*this, pipeline_cache_);
}

/// A cache is a convenience: a folder that cannot be written costs start-up time, nothing else.
void Device::savePipelineCache() const
{
    const size_t byte_count = cacheData(device_, pipeline_cache_).size();
    if (pipeline_cache_path_.empty() || byte_count == 0 || byte_count == pipeline_cache_bytes_)
        return; // nothing is new
    // Programs that began with this one may have ended since: theirs stay, too.
    const VkPipelineCache others = pipelineCacheOf(fileContent(pipeline_cache_path_));
    vkMergePipelineCaches(device_, pipeline_cache_, 1, &others);
    vkDestroyPipelineCache(device_, others, nullptr);
    const std::vector<char> data = cacheData(device_, pipeline_cache_);
    std::error_code ignored;
    std::filesystem::create_directories(pipeline_cache_path_.parent_path(), ignored);
    TemporaryFile file(pipeline_cache_path_);
    if (file.isOpen() && file.append(std::as_bytes(std::span(data))))
        file.commit(Durability::kUntilPowerCut);
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

Kernel Device::createKernel(const KernelCode& code, std::vector<ConstantValue> constants) const
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

    ++pipeline_count_;
    pipelines_->build(kernel.state_, std::move(constants));
    return kernel;
}

std::vector<std::string> Device::statistics(VkPipeline pipeline) const
{
    const auto get_executables = PFN_vkGetPipelineExecutablePropertiesKHR(
        keeps_statistics_ ? vkGetDeviceProcAddr(device_, "vkGetPipelineExecutablePropertiesKHR") : nullptr);
    const auto get_statistics =
        PFN_vkGetPipelineExecutableStatisticsKHR(vkGetDeviceProcAddr(device_, "vkGetPipelineExecutableStatisticsKHR"));
    if (!get_executables || !get_statistics || !pipeline)
        return {};
    const VkPipelineInfoKHR info{.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR, .pipeline = pipeline};
    uint32_t executable_count = 0;
    vulkanCheck(get_executables(device_, &info, &executable_count, nullptr));
    std::vector<std::string> texts;
    for (uint32_t i = 0; i < executable_count; ++i)
    {
        const VkPipelineExecutableInfoKHR executable{
            .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline, .executableIndex = i};
        uint32_t count = 0;
        vulkanCheck(get_statistics(device_, &executable, &count, nullptr));
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
        vulkanCheck(get_statistics(device_, &executable, &count, statistics.data()));
        for (const VkPipelineExecutableStatisticKHR& s : statistics)
            texts.push_back(s.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR
                                ? fmt::format("{} {:.3g}", s.name, s.value.f64)
                                : fmt::format("{} {}", s.name,
                                              s.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR
                                                  ? s.value.b32
                                                  : s.value.u64));
    }
    return texts;
}
