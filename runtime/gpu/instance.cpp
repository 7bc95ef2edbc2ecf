#include "runtime/gpu/instance.h"

#include "format/temporary_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

const char* vulkanResultName(VkResult result)
{
    switch (result)
    {
    case VK_SUCCESS:
        return "VK_SUCCESS";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
        return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_SURFACE_LOST_KHR:
        return "VK_ERROR_SURFACE_LOST_KHR";
    case VK_ERROR_OUT_OF_DATE_KHR:
        return "VK_ERROR_OUT_OF_DATE_KHR";
    default:
        return "another Vulkan error";
    }
}

bool isDeviceFailure(VkResult result)
{
    return result == VK_ERROR_DEVICE_LOST || result == VK_ERROR_OUT_OF_DEVICE_MEMORY ||
           result == VK_ERROR_OUT_OF_HOST_MEMORY;
}

void endForAnotherTry(const std::string& what)
{
    fmt::print(stderr, "the device: error: {}; another try may succeed\n", what);
    removeOpenTemporaryFiles();
    std::_Exit(int(kTryAgain));
}

namespace
{
VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void*)
{
    fmt::print(stderr, "validation: {}\n", data->pMessage);
    // Warnings of the layer point at bugs as surely as its errors do; both stop the program.
    check(severity < VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT, "{}",
          data->pMessageIdName ? data->pMessageIdName : "");
    return VK_FALSE;
}

bool hasLayer(const char* name)
{
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const auto& layer) { return std::strcmp(layer.layerName, name) == 0; });
}

const char* kindName(VkPhysicalDeviceType type)
{
    switch (type)
    {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "cpu";
    default:
        return "other";
    }
}

bool hasExtension(VkPhysicalDevice device, const char* name)
{
    uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

std::vector<std::string> missingFeatures(VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties)
{
    std::vector<std::string> lacks;
    if (properties.apiVersion < VK_API_VERSION_1_3)
    {
        lacks.push_back(fmt::format("Vulkan 1.3 (it offers {}.{}): a newer driver is needed",
                                    VK_API_VERSION_MAJOR(properties.apiVersion),
                                    VK_API_VERSION_MINOR(properties.apiVersion)));
        return lacks; // the structures below are 1.3's
    }
    VkPhysicalDeviceVulkan13Features f13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features f12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &f13};
    VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &f12};
    vkGetPhysicalDeviceFeatures2(device, &features);
    const auto need = [&](VkBool32 has, const char* text)
    {
        if (!has)
            lacks.push_back(text);
    };
    need(f12.scalarBlockLayout, "scalarBlockLayout: C++ and shaders share one struct layout");
    need(f13.synchronization2, "synchronization2: barriers");
    need(f13.maintenance4, "maintenance4: workgroup sizes given by constants");
    need(hasExtension(device, VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME), "VK_KHR_push_descriptor: every kernel's buffers");
    need(properties.limits.maxPushConstantsSize >= 128, "128 bytes of push constants: kernel parameters");
    need(properties.limits.maxPerStageDescriptorStorageBuffers >= 20,
         "20 storage buffers a stage: scene and stage buffers");
    need(properties.limits.maxPerStageDescriptorSampledImages >= 23,
         "23 sampled images a stage: texture pages, scene data");
    need(properties.limits.maxComputeWorkGroupInvocations >= 256, "workgroups of 256 invocations");
    return lacks;
}

std::string lower(std::string text)
{
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::string describe(std::span<const DeviceInfo> devices)
{
    if (devices.empty())
        return "there is no Vulkan device at all; install a driver (Debian: mesa-vulkan-drivers)";
    std::string text = "devices found:";
    for (const DeviceInfo& d : devices)
    {
        text += fmt::format("\n  {}: {} ({})", d.index, d.name, d.kind);
        for (const std::string& lack : d.lacks)
            text += fmt::format("\n     lacks {}", lack);
    }
    return text;
}
} // namespace

Instance::State::~State()
{
    if (messenger)
        if (auto destroy =
                PFN_vkDestroyDebugUtilsMessengerEXT(vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT")))
            destroy(instance, messenger, nullptr);
    if (instance)
        vkDestroyInstance(instance, nullptr);
}

Result<Instance> Instance::create(const InstanceOptions& options)
{
    constexpr const char* kValidation = "VK_LAYER_KHRONOS_validation";
    if (options.validation && !hasLayer(kValidation))
        return Error{ExitCode::kDevice,
                     "the Vulkan validation layer is not installed (Debian: vulkan-validationlayers)"};

    std::vector<const char*> extensions(options.extensions.begin(), options.extensions.end());
    const VkDebugUtilsMessengerCreateInfoEXT messenger{
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
        .pfnUserCallback = onMessage,
    };
    constexpr std::array kChecks{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    const VkValidationFeaturesEXT checks{
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = uint32_t(kChecks.size()),
        .pEnabledValidationFeatures = kChecks.data(),
    };
    if (options.validation)
        extensions.insert(extensions.end(),
                          {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME});

    const VkApplicationInfo app{
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .pApplicationName = "lumicut", .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = options.validation ? &checks : nullptr,
        .pApplicationInfo = &app,
        .enabledLayerCount = options.validation ? 1u : 0u,
        .ppEnabledLayerNames = &kValidation,
        .enabledExtensionCount = uint32_t(extensions.size()),
        .ppEnabledExtensionNames = extensions.data(),
    };
    Instance instance;
    instance.state_ = std::make_shared<State>();
    if (const VkResult result = vkCreateInstance(&info, nullptr, &instance.state_->instance); result != VK_SUCCESS)
        return Error{ExitCode::kDevice, fmt::format("Vulkan cannot be started ({}); is a Vulkan driver installed "
                                                    "(Debian: mesa-vulkan-drivers)?",
                                                    vulkanResultName(result))};
    const VkInstance handle = instance.state_->instance;
    if (options.validation)
        if (auto create =
                PFN_vkCreateDebugUtilsMessengerEXT(vkGetInstanceProcAddr(handle, "vkCreateDebugUtilsMessengerEXT")))
            vulkanCheck(create(handle, &messenger, nullptr, &instance.state_->messenger));

    uint32_t count = 0;
    vulkanCheck(vkEnumeratePhysicalDevices(handle, &count, nullptr));
    instance.state_->devices.resize(count);
    vulkanCheck(vkEnumeratePhysicalDevices(handle, &count, instance.state_->devices.data()));
    return instance;
}

std::vector<DeviceInfo> Instance::devices() const
{
    std::vector<DeviceInfo> infos;
    for (uint32_t i = 0; i < state_->devices.size(); ++i)
    {
        VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2,
                                               .pNext = &driver};
        vkGetPhysicalDeviceProperties2(state_->devices[i], &properties);
        VkPhysicalDeviceMemoryProperties memory;
        vkGetPhysicalDeviceMemoryProperties(state_->devices[i], &memory);
        DeviceInfo info{
            .index = i,
            .name = properties.properties.deviceName,
            .kind = kindName(properties.properties.deviceType),
            .driver = fmt::format("{} {}", driver.driverName, driver.driverInfo),
            .tells_statistics = hasExtension(state_->devices[i], VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME),
            .lacks = missingFeatures(state_->devices[i], properties.properties),
        };
        for (uint32_t h = 0; h < memory.memoryHeapCount; ++h)
            if (memory.memoryHeaps[h].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
                info.memory_bytes = std::max(info.memory_bytes, uint64_t(memory.memoryHeaps[h].size));
        infos.push_back(std::move(info));
    }
    return infos;
}

Result<uint32_t> selectDevice(std::span<const DeviceInfo> devices, const std::string& selector)
{
    const auto matches = [&](const DeviceInfo& d)
    {
        if (selector.empty())
            return true;
        if (std::ranges::all_of(selector, [](unsigned char c) { return std::isdigit(c); }))
            return std::to_string(d.index) == selector;
        if (selector == "cpu")
            return d.kind == "cpu";
        return lower(d.name).find(lower(selector)) != std::string::npos;
    };
    constexpr std::array kPreference{"discrete", "integrated", "virtual", "cpu", "other"};
    const DeviceInfo* best = nullptr;
    const auto rank = [&](const DeviceInfo& d) { return std::ranges::find(kPreference, d.kind) - kPreference.begin(); };
    bool matched = false;
    for (const DeviceInfo& d : devices)
    {
        matched |= matches(d);
        if (matches(d) && d.lacks.empty() && (!best || rank(d) < rank(*best)))
            best = &d;
    }
    if (best)
        return best->index;
    if (!selector.empty() && !matched)
        return Error{ExitCode::kDevice, fmt::format("no device matches '{}'; {}", selector, describe(devices))};
    return Error{ExitCode::kDevice, fmt::format("no device can run this player; {}", describe(devices))};
}
