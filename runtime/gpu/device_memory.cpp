#include "runtime/gpu/device.h"

#include <algorithm>
#include <array>

std::shared_ptr<Memory> Device::allocate(const VkMemoryRequirements& needs, Placement placement) const
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
            auto memory = std::make_shared<Memory>();
            if (vkAllocateMemory(device_, &info, nullptr, &memory->memory_) != VK_SUCCESS)
                continue;
            memory->device_ = device_;
            memory->size_ = needs.size;
            memory->total_ = &allocated_bytes_;
            allocated_bytes_ += needs.size;
            ++allocation_count_;
            // Large device-local memory of a discrete GPU may be mappable too; only CPU-side devices gain by mapping it.
            if ((flags & kVisible) == kVisible && (placement != Placement::kDevice || isCpu()))
            {
                void* pointer = nullptr;
                vulkanCheck(vkMapMemory(device_, memory->memory_, 0, VK_WHOLE_SIZE, 0, &pointer));
                memory->mapped_ = {static_cast<std::byte*>(pointer), size_t(needs.size)};
            }
            return memory;
        }
    return nullptr;
}

Buffer Device::buffer(std::string_view name, uint64_t bytes, Placement placement, const Scratch& scratch) const
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
    const auto allocated = [&](uint64_t size) {
        return allocate({.size = size, .alignment = needs.alignment, .memoryTypeBits = needs.memoryTypeBits},
                        placement);
    };
    if (scratch.stage_)
    {
        Scratch::Place place = scratch.place(needs, allocated);
        buffer.memory_ = std::move(place.memory);
        buffer.offset_ = place.offset;
    }
    else
        buffer.memory_ = allocated(needs.size);
    if (!buffer.memory_)
        endForAnotherTry(fmt::format("out of device memory, buffer '{}' of {} bytes", name, bytes));
    vulkanCheck(vkBindBufferMemory(device_, buffer.buffer_, buffer.memory_->handle(), buffer.offset_));
    if (!buffer.memory_->mapped_.empty())
        buffer.mapped_ = buffer.memory_->mapped_.subspan(buffer.offset_, bytes);
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
