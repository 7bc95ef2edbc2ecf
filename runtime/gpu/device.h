// The selected device: creates kernels, buffers and images, and uploads data.
#pragma once
#include "format/result.h"
#include "runtime/gpu/instance.h"
#include "runtime/gpu/kernel.h"
#include "runtime/gpu/memory.h"
#include "runtime/gpu/pipeline_builder.h"
#include "runtime/gpu/scratch.h"

#include <cstring>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

/// What a device is opened for, beside running kernels.
struct DeviceUse
{
    bool present = false;           // to windows
    bool kernel_statistics = false; // Device::statistics()
};

class Device
{
public:
    /// @param index into Instance::devices(); the device must lack nothing
    static Result<std::unique_ptr<Device>> create(const Instance& instance, uint32_t index, const DeviceUse& use = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    /// "samples/assign" is shaders/samples/assign.comp. Aborts where there is no such kernel.
    /// Kernels are cached: the same name and constants give the same one. Returns at once, while threads build the pipeline (pipeline()).
    /// @param constants of the kernel; others keep the value in the shader. Aborts where the kernel does not use one of them.
    Kernel kernel(std::string_view name, std::initializer_list<Constant> constants = {}) const
    {
        return kernel(name, SharedConstants(), constants);
    }
    /// @param shared of which the kernel takes those it uses. Aborts where no kernel at all uses one of them.
    Kernel kernel(std::string_view name, const SharedConstants& shared,
                  std::initializer_list<Constant> constants = {}) const;
    /// The same of a kernel that is not one of kernelCodes(); of another name than any of them.
    Kernel kernel(const KernelCode& code, const SharedConstants& shared,
                  std::initializer_list<Constant> constants = {}) const;

    /// What a word of new memory holds under validation: no number as a float, far too many as a count. Without this
    /// a kernel that reads what nothing wrote is right as long as the memory happens to be zero.
    static constexpr uint32_t kUnwritten = 0x7fc07fc0;

    /// Device-local storage for `count` elements (at least one), filled with zeroes only by Recorder::clear.
    /// Aborts when memory runs out.
    /// @param scratch in whose memory the buffer is made
    template <typename T>
    Buffer array(std::string_view name, uint64_t count, const Scratch& scratch = {}) const
    {
        return buffer(name, (count > 0 ? count : 1) * sizeof(T), Placement::kDevice, scratch);
    }
    /// The same for what some kernel reads as a `usamplerBuffer`: software Vulkan fetches a texel with one wide load,
    /// where a storage block costs it a bounds-checked load a word. Aborts above limits().maxTexelBufferElements
    /// texels.
    template <typename T>
    Buffer texelArray(std::string_view name, uint64_t count, const Scratch& scratch = {}) const
    {
        static_assert(sizeof(T) % kTexelBytes == 0);
        return withTexels(array<T>(name, count, scratch));
    }
    /// Host-visible memory that the GPU writes and the CPU reads.
    Buffer readback(std::string_view name, uint64_t bytes) const { return buffer(name, bytes, Placement::kReadback); }
    /// Host-visible memory that the CPU writes and the GPU copies from.
    Buffer stagingBuffer(std::string_view name, uint64_t bytes) const
    {
        return buffer(name, bytes, Placement::kStaging);
    }

    /// A device-local buffer with the given contents; waits until they are there.
    template <typename T>
    Buffer upload(std::string_view name, std::span<const T> data) const
    {
        return uploadBytes(name, std::as_bytes(data));
    }
    /// The same with a texel view.
    template <typename T>
    Buffer uploadTexels(std::string_view name, std::span<const T> data) const
    {
        static_assert(sizeof(T) % kTexelBytes == 0);
        return withTexels(uploadBytes(name, std::as_bytes(data)));
    }
    /// An image in shader-read layout; `data` is laid out level by level, layer by layer, tightly packed.
    Image uploadImage(std::string_view name, const ImageShape& shape, std::span<const std::byte> data) const;

    /// Copies a buffer's contents to the CPU; waits for the queue.
    template <typename T>
    std::vector<T> download(const Buffer& source, uint64_t count) const
    {
        std::vector<T> data(count);
        downloadBytes(source, std::as_writable_bytes(std::span(data)));
        return data;
    }

    void waitIdle() const { vulkanCheck(vkDeviceWaitIdle(device_)); }

    VkDevice handle() const { return device_; }
    VkPhysicalDevice physical() const { return physical_; }
    VkQueue queue() const { return queue_; }
    uint32_t queueFamily() const { return queue_family_; }
    VkDescriptorSetLayout sceneSetLayout() const { return scene_set_layout_; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    std::string name() const { return properties_.deviceName; }
    bool isCpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    /// Block-compressed images are sampled by hardware.
    bool samplesBlocks() const { return samples_blocks_; }
    /// The kernel's pipeline; waits until it is built.
    VkPipeline pipeline(const Kernel& kernel) const { return pipelines_->wait(*kernel.state_); }
    bool keepsStatistics() const { return keeps_statistics_; }
    /// What the driver says of a kernel's machine code, as "Register Count 64", in its own words; empty where it says nothing, or
    /// the device was not opened for it.
    std::vector<std::string> statistics(VkPipeline pipeline) const;
    /// Pipelines that are not being built yet never are. For a program that ends without closing the device.
    void stopBuilding() { pipelines_->stop(); }
    /// Milliseconds spent waiting for pipelines so far.
    double pipelineMs() const { return pipelines_->waitedMs(); }
    /// Pipelines asked for so far.
    uint64_t pipelineCount() const { return pipeline_count_; }
    /// Memory that buffers and images have now, bytes.
    uint64_t allocatedBytes() const { return allocated_bytes_; }
    /// Allocations of memory made so far.
    uint64_t allocationCount() const { return allocation_count_; }
    /// Names a Vulkan object for validation messages and captures; does nothing without the debug extension.
    void nameObject(VkObjectType type, uint64_t handle, std::string_view name) const;

private:
    enum class Placement
    {
        kDevice,
        kReadback,
        kStaging
    };
    Device() = default;
    void createLayouts();
    VkPipelineCache pipelineCacheOf(std::span<const char> data) const;
    void loadPipelineCache();
    void savePipelineCache() const;
    using ConstantValue = PipelineBuilder::ConstantValue;
    static std::vector<ConstantValue> constantValues(const KernelCode& code, const SharedConstants& shared,
                                                     std::initializer_list<Constant> constants);
    Kernel createKernel(const KernelCode& code, std::vector<ConstantValue> constants) const;
    Buffer buffer(std::string_view name, uint64_t bytes, Placement placement, const Scratch& scratch = {}) const;
    Buffer withTexels(Buffer buffer) const;
    Buffer uploadBytes(std::string_view name, std::span<const std::byte> data) const;
    /// Memory that the CPU writes and the GPU copies from, of at least `bytes`; what was in it is lost.
    const Buffer& staging(uint64_t bytes) const;
    void downloadBytes(const Buffer& source, std::span<std::byte> data) const;
    /// @return null when memory runs out
    std::shared_ptr<Memory> allocate(const VkMemoryRequirements& needs, Placement placement) const;
    void submitOnce(const std::function<void(VkCommandBuffer)>& record) const;

    Instance instance_;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    VkPhysicalDeviceProperties properties_{};
    bool samples_blocks_ = false;
    VkPhysicalDeviceMemoryProperties memory_{};
    VkDescriptorSetLayout scene_set_layout_ = VK_NULL_HANDLE;
    VkCommandPool once_pool_ = VK_NULL_HANDLE;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    std::filesystem::path pipeline_cache_path_;
    size_t pipeline_cache_bytes_ = 0; // as it was loaded; 0: there was none
    PFN_vkSetDebugUtilsObjectNameEXT set_name_ = nullptr;
    std::unique_ptr<PipelineBuilder> pipelines_;
    mutable std::map<std::pair<std::string, std::vector<ConstantValue>>, Kernel> kernels_; // by name and constants
    mutable Buffer staging_; // kept: drivers take longer to lock such memory in place than to copy what goes through it
    bool keeps_statistics_ = false;
    mutable uint64_t pipeline_count_ = 0, allocated_bytes_ = 0, allocation_count_ = 0;
};
