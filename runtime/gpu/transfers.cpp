#include "format/block_texture.h"
#include "runtime/gpu/device.h"

#include <algorithm>

namespace
{
constexpr uint64_t kStagingBytes = uint64_t(16) << 20;
} // namespace

void Device::submitOnce(const std::function<void(VkCommandBuffer)>& record) const
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
    image.memory_ = allocate(needs, Placement::kDevice);
    if (!image.memory_)
        endForAnotherTry(fmt::format("out of device memory, image '{}' of {} bytes", name, needs.size));
    vulkanCheck(vkBindImageMemory(device_, image.image_, image.memory_->handle(), 0));
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
