// Device memory: buffers and sampled images, and the allocations that they lie in.
#pragma once
#include "runtime/gpu/vulkan.h"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

constexpr uint64_t kTexelBytes = 16; // of a texel view: four 32-bit words, RGBA32UI

/// One allocation. Buffers and images that lie in it keep it; it is freed with the last of them.
class Memory
{
public:
    Memory() = default;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory();

    VkDeviceMemory handle() const { return memory_; }
    uint64_t size() const { return size_; } // bytes

private:
    friend class Device;
    VkDevice device_ = VK_NULL_HANDLE;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    uint64_t size_ = 0;
    std::span<std::byte> mapped_; // empty where the CPU cannot reach it
    uint64_t* total_ = nullptr;   // bytes of all allocations of the device
};

/// Bytes [begin, end) of an allocation.
struct MemoryRange
{
    const Memory* memory = nullptr;
    uint64_t begin = 0, end = 0;
    bool overlaps(const MemoryRange& other) const
    {
        return memory == other.memory && begin < other.end && other.begin < end;
    }
    bool operator==(const MemoryRange&) const = default;
};

/// Device-local memory owned by this object, or shared with others (ScratchPool). Its owner keeps it alive until the GPU is done
/// with it.
class Buffer
{
public:
    Buffer() = default;
    Buffer(Buffer&& other) noexcept { swap(other); }
    Buffer& operator=(Buffer&& other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Buffer();

    uint64_t size() const { return size_; } // bytes
    VkBuffer handle() const { return buffer_; }
    /// The whole buffer for texelFetch, kTexelBytes a texel; null where it was not made for that.
    const VkBufferView& texels() const { return texels_; }
    const std::string& name() const { return name_; }
    /// The buffer's bytes where the CPU can reach them (host-visible memory), else empty.
    std::span<std::byte> mapped() const { return mapped_; }
    /// Where it lies: buffers whose ranges overlap change each other.
    MemoryRange range() const { return {memory_.get(), offset_, offset_ + size_}; }
    explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

private:
    friend class Device;
    void swap(Buffer& other);
    VkDevice device_ = VK_NULL_HANDLE;
    VkBuffer buffer_ = VK_NULL_HANDLE;
    VkBufferView texels_ = VK_NULL_HANDLE;
    std::shared_ptr<Memory> memory_;
    uint64_t offset_ = 0; // in memory_
    uint64_t size_ = 0;
    std::span<std::byte> mapped_;
    std::string name_;
};

/// A sampled 2D or 2D-array image with its view.
class Image
{
public:
    Image() = default;
    Image(Image&& other) noexcept { swap(other); }
    Image& operator=(Image&& other) noexcept
    {
        swap(other);
        return *this;
    }
    ~Image();

    VkImageView view() const { return view_; }
    VkImage handle() const { return image_; }

private:
    friend class Device;
    void swap(Image& other);
    VkDevice device_ = VK_NULL_HANDLE;
    VkImage image_ = VK_NULL_HANDLE;
    VkImageView view_ = VK_NULL_HANDLE;
    std::shared_ptr<Memory> memory_;
};

struct ImageShape
{
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    uint32_t width = 1; // texels
    uint32_t height = 1;
    uint32_t layers = 1;
    uint32_t levels = 1;
    bool array = false; // view as sampler2DArray
};
