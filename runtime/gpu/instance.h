// The Vulkan instance, its validation messages, and the list of devices with what each one lacks.
#pragma once
#include "format/result.h"
#include "runtime/gpu/vulkan.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

struct InstanceOptions
{
    /// Core and synchronization validation; a message aborts. New memory then holds Device::kUnwritten.
    bool validation = false;
    std::span<const char* const> extensions = {}; // what the window library asks for
};

/// One physical device as `--list-devices` shows it.
struct DeviceInfo
{
    uint32_t index = 0; // the loader's order
    std::string name;
    std::string kind; // "discrete", "integrated", "cpu", "virtual", "other"
    std::string driver;
    uint64_t memory_bytes = 0;      // largest device-local heap
    bool tells_statistics = false;  // of kernels (VK_KHR_pipeline_executable_properties)
    std::vector<std::string> lacks; // each required feature that is missing, with its reason; empty: suitable
};

class Instance
{
public:
    /// @return kDevice where there is no Vulkan 1.3 loader, or validation is asked for and not installed
    static Result<Instance> create(const InstanceOptions& options);

    std::vector<DeviceInfo> devices() const;
    VkInstance handle() const { return state_->instance; }
    bool validates() const { return state_->messenger != VK_NULL_HANDLE; }
    VkPhysicalDevice physicalDevice(uint32_t index) const { return state_->devices.at(index); }

private:
    struct State
    {
        VkInstance instance = VK_NULL_HANDLE;
        VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
        std::vector<VkPhysicalDevice> devices;
        ~State();
    };
    std::shared_ptr<State> state_;
};

/// Picks by `selector`: empty (best suitable: discrete, then integrated, then virtual, then CPU), an index, "cpu", or a
/// part of the name (case-insensitive).
/// @return the index, or kDevice with the list of devices and what each one lacks
Result<uint32_t> selectDevice(std::span<const DeviceInfo> devices, const std::string& selector);
