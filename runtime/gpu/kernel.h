// A compute pipeline and the reflection of its SPIR-V, made at build time.
#pragma once
#include "runtime/gpu/vulkan.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

/// One storage block of a kernel (descriptor set 1), or a `uniform usamplerBuffer`, which is read only.
struct KernelBlock
{
    std::string_view name; // the GLSL block name, or the usamplerBuffer's
    uint32_t binding;
    bool reads;
    bool writes;
    bool texels; // a usamplerBuffer: its buffer must have a texel view (Device::texelArray)
};

/// A specialization constant that a kernel uses.
struct KernelConstant
{
    std::string_view name; // "kRun"
    uint32_t id;
};

/// The value of a specialization constant; of a bool, 0 or 1.
struct Constant
{
    std::string_view name;
    uint32_t value;
};

/// Constants that many kernels are given, of which each takes those it uses. Does not own them.
struct SharedConstants
{
    SharedConstants() = default;
    explicit SharedConstants(std::span<const Constant> constants) : list(constants) {}
    std::span<const Constant> list;
};

/// A compiled shader with its reflection, written by the build (shaders/CMakeLists.txt).
struct KernelCode
{
    std::string_view name; // "samples/assign"
    std::span<const uint32_t> words;
    std::span<const KernelBlock> blocks;
    std::span<const uint32_t> scene_bindings; // buffers of descriptor set 0 that it reads
    std::span<const KernelConstant> constants;
    uint32_t push_bytes;
    uint32_t group_size; // local_size_x; kernels are one-dimensional
};

/// Every kernel of the build, sorted by name.
std::span<const KernelCode> kernelCodes();

/// A compute pipeline, which Device::pipeline() waits for; a handle that may be copied. Lives no longer than its Device.
class Kernel
{
public:
    const KernelCode& code() const { return *state_->code; }
    VkPipelineLayout layout() const { return state_->layout; }

private:
    friend class Device;
    friend class PipelineBuilder;
    struct State
    {
        VkDevice device = VK_NULL_HANDLE;
        const KernelCode* code = nullptr;
        VkPipeline pipeline = VK_NULL_HANDLE; // PipelineBuilder's, until it is built
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
        ~State();
    };
    std::shared_ptr<State> state_;
};
