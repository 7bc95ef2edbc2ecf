// Our decoder of blocks against the device's own, over random bytes in every mode.
#include "format/block_texture.h"
#include "tests/stages/gpu_test.h"

#include <random>

namespace
{
constexpr uint32_t kAcross = 32; // blocks along a side of the image
constexpr uint32_t kSide = blocks::kSide * kAcross;

class BlockImage : public GpuTest
{
protected:
    static bool deviceReads(VkFormat format)
    {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(device().physical(), format, &properties);
        return (properties.optimalTilingFeatures & VK_FORMAT_FEATURE_BLIT_SRC_BIT) != 0;
    }

    /// RGBA8 of kSide x kSide texels, as the device decodes them.
    static std::vector<uint8_t> decodedByDevice(VkFormat format, const std::vector<std::byte>& bytes)
    {
        const Image from =
            device().uploadImage("test.blocks", {.format = format, .width = kSide, .height = kSide}, bytes);
        const Image to = device().uploadImage("test.texels", {.width = kSide, .height = kSide},
                                              std::vector<std::byte>(size_t(4) * kSide * kSide));
        const Buffer texels = device().readback("test.readback", uint64_t(4) * kSide * kSide);
        submit(
            [&](VkCommandBuffer commands)
            {
                move(commands, from, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
                move(commands, to, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
                const VkImageSubresourceLayers whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
                const VkImageBlit blit{.srcSubresource = whole,
                                       .srcOffsets = {{0, 0, 0}, {int32_t(kSide), int32_t(kSide), 1}},
                                       .dstSubresource = whole,
                                       .dstOffsets = {{0, 0, 0}, {int32_t(kSide), int32_t(kSide), 1}}};
                vkCmdBlitImage(commands, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
                move(commands, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
                const VkBufferImageCopy copy{.imageSubresource = whole, .imageExtent = {kSide, kSide, 1}};
                vkCmdCopyImageToBuffer(commands, to.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, texels.handle(), 1,
                                       &copy);
            });
        return device().download<uint8_t>(texels, size_t(4) * kSide * kSide);
    }

private:
    static void move(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to)
    {
        const VkImageMemoryBarrier2 barrier{
            .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
            .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
            .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
            .oldLayout = from,
            .newLayout = to,
            .image = image.handle(),
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
        };
        const VkDependencyInfo info{
            .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier};
        vkCmdPipelineBarrier2(commands, &info);
    }

    template <typename Record>
    static void submit(const Record& record)
    {
        const VkCommandPoolCreateInfo pool_info{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                                .queueFamilyIndex = device().queueFamily()};
        VkCommandPool pool;
        vulkanCheck(vkCreateCommandPool(device().handle(), &pool_info, nullptr, &pool));
        const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                   .commandPool = pool,
                                                   .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                   .commandBufferCount = 1};
        VkCommandBuffer commands;
        vulkanCheck(vkAllocateCommandBuffers(device().handle(), &allocate, &commands));
        const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        vulkanCheck(vkBeginCommandBuffer(commands, &begin));
        record(commands);
        vulkanCheck(vkEndCommandBuffer(commands));
        const VkSubmitInfo submit_info{
            .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
        vulkanCheck(vkQueueSubmit(device().queue(), 1, &submit_info, VK_NULL_HANDLE));
        device().waitIdle();
        vkDestroyCommandPool(device().handle(), pool, nullptr);
    }
};

std::vector<std::byte> randomBytes(size_t count)
{
    std::mt19937 random(7);
    std::vector<std::byte> bytes(count);
    for (std::byte& b : bytes)
        b = std::byte(random() >> 24);
    return bytes;
}

/// @param tolerance steps of 255 @param channels that are compared
template <size_t Bytes, typename Decode>
void expectSame(const std::vector<std::byte>& bytes, const std::vector<uint8_t>& expected, int tolerance,
                size_t channels, const Decode& decode)
{
    for (size_t b = 0; b < kAcross * kAcross; ++b)
    {
        const blocks::Texels texels = decode(std::span<const std::byte, Bytes>(bytes.data() + Bytes * b, Bytes));
        for (size_t i = 0; i < 16; ++i)
            for (size_t c = 0; c < channels; ++c)
            {
                const size_t x = b % kAcross * 4 + i % 4, y = b / kAcross * 4 + i / 4;
                ASSERT_NEAR(texels[i][c], expected[4 * (y * kSide + x) + c], tolerance)
                    << "block " << b << ", first byte " << int(bytes[Bytes * b]) << ", texel " << i << ", channel "
                    << c;
            }
    }
}

TEST_F(BlockImage, Bc7IsDecodedAsTheDeviceDoesInEveryMode)
{
    if (!deviceReads(VK_FORMAT_BC7_UNORM_BLOCK))
        GTEST_SKIP() << "the device cannot copy from BC7";
    std::vector<std::byte> bytes = randomBytes(16 * kAcross * kAcross);
    for (size_t b = 0; b < kAcross * kAcross; ++b) // every mode, and the reserved one, as often as any
        bytes[16 * b] =
            b % 9 == 8 ? std::byte(0) : (bytes[16 * b] & std::byte(0xff << (b % 9 + 1))) | std::byte(1 << (b % 9));
    const std::vector<uint8_t> expected = decodedByDevice(VK_FORMAT_BC7_UNORM_BLOCK, bytes);
    expectSame<16>(bytes, expected, 0, 4, blocks::decodeBc7); // the format leaves no room for rounding
}

TEST_F(BlockImage, Bc4AndBc5AreDecodedAsTheDeviceDoes)
{
    if (!deviceReads(VK_FORMAT_BC4_UNORM_BLOCK) || !deviceReads(VK_FORMAT_BC5_UNORM_BLOCK))
        GTEST_SKIP() << "the device cannot copy from BC4 and BC5";
    const std::vector<std::byte> bytes = randomBytes(16 * kAcross * kAcross);
    const std::vector<std::byte> half(bytes.begin(), bytes.begin() + 8 * kAcross * kAcross);
    // Devices round as they like, and software Vulkan takes 51 / 256 for a fifth: one step for each.
    expectSame<8>(half, decodedByDevice(VK_FORMAT_BC4_UNORM_BLOCK, half), 2, 1, blocks::decodeBc4);
    expectSame<16>(bytes, decodedByDevice(VK_FORMAT_BC5_UNORM_BLOCK, bytes), 2, 2, blocks::decodeBc5);
}
} // namespace
