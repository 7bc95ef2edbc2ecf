#include "runtime/gpu/swapchain.h"

#include <algorithm>
#include <array>
#include <optional>

namespace
{
constexpr VkImageUsageFlags kUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
constexpr uint32_t kWantedImages = 3;
constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

/// @return nothing where the surface is gone
std::optional<VkSurfaceCapabilitiesKHR> capabilities(const Device& device, VkSurfaceKHR surface)
{
    VkSurfaceCapabilitiesKHR caps;
    const VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &caps);
    if (result == VK_ERROR_SURFACE_LOST_KHR)
        return std::nullopt;
    vulkanCheck(result);
    return caps;
}

VkExtent2D imageExtent(const VkSurfaceCapabilitiesKHR& caps, VkExtent2D wanted)
{
    constexpr uint32_t kFree = 0xffffffffu; // the surface takes the size of its images
    if (caps.currentExtent.width != kFree)
        return caps.currentExtent;
    return {std::clamp(wanted.width, caps.minImageExtent.width, caps.maxImageExtent.width),
            std::clamp(wanted.height, caps.minImageExtent.height, caps.maxImageExtent.height)};
}

uint32_t wantedImageCount(const VkSurfaceCapabilitiesKHR& caps)
{
    const uint32_t most = caps.maxImageCount > 0 ? caps.maxImageCount : kWantedImages; // 0: any number
    return std::max(std::min(kWantedImages, most), caps.minImageCount);
}

VkCompositeAlphaFlagBitsKHR compositeAlpha(const VkSurfaceCapabilitiesKHR& caps)
{
    if (caps.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR)
        return VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    return VkCompositeAlphaFlagBitsKHR(caps.supportedCompositeAlpha &
                                       (~caps.supportedCompositeAlpha + 1)); // any: the lowest
}

VkSemaphore semaphore(const Device& device)
{
    const VkSemaphoreCreateInfo info{.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore made = VK_NULL_HANDLE;
    vulkanCheck(vkCreateSemaphore(device.handle(), &info, nullptr, &made));
    return made;
}

} // namespace

bool Swapchain::fits(VkResult result)
{
    lost_ |= result == VK_ERROR_SURFACE_LOST_KHR;
    if (lost_ || result == VK_ERROR_OUT_OF_DATE_KHR)
        return false;
    vulkanCheck(result);
    return true;
}

Swapchain::Swapchain(const Instance& instance, const Device& device, VkSurfaceKHR surface)
    : instance_(instance), device_(device), surface_(surface)
{
}

Result<std::unique_ptr<Swapchain>> Swapchain::create(const Instance& instance, const Device& device,
                                                     VkSurfaceKHR surface)
{
    std::unique_ptr<Swapchain> swapchain(new Swapchain(instance, device, surface));
    if (const Status status = swapchain->choose(); !status)
        return status.error();
    swapchain->createOverlayPass();
    for (VkSemaphore& acquired : swapchain->acquired_)
        acquired = semaphore(device);
    return swapchain;
}

Swapchain::~Swapchain()
{
    device_.waitIdle();
    destroyFrames();
    for (const VkSemaphore acquired : acquired_)
        vkDestroySemaphore(device_.handle(), acquired, nullptr);
    vkDestroyRenderPass(device_.handle(), overlay_pass_, nullptr);
    vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
    vkDestroySurfaceKHR(instance_.handle(), surface_, nullptr);
}

Status Swapchain::choose()
{
    VkBool32 supported = VK_FALSE;
    vulkanCheck(vkGetPhysicalDeviceSurfaceSupportKHR(device_.physical(), device_.queueFamily(), surface_, &supported));
    std::vector<VkSurfaceFormatKHR> formats;
    if (supported)
    {
        uint32_t count = 0;
        vulkanCheck(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, nullptr));
        formats.resize(count);
        vulkanCheck(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, formats.data()));
        const auto caps = capabilities(device_, surface_);
        supported = caps && (caps->supportedUsageFlags & kUsage) == kUsage;
    }
    // The pixels are sRGB-encoded already, so the images must not encode again.
    const auto format = std::ranges::find_if(formats,
                                             [](const VkSurfaceFormatKHR& f)
                                             {
                                                 return (f.format == VK_FORMAT_B8G8R8A8_UNORM ||
                                                         f.format == VK_FORMAT_R8G8B8A8_UNORM) &&
                                                        f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
                                             });
    if (!supported || format == formats.end())
        return Error{ExitCode::kDevice,
                     fmt::format("{} cannot show pictures on this display; choose another device with --device "
                                 "(see --list-devices), or render to a file with --headless",
                                 device_.name())};
    format_ = format->format;
    return Success{};
}

void Swapchain::createOverlayPass()
{
    const VkAttachmentDescription attachment{
        .format = format_,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass{.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                       .colorAttachmentCount = 1,
                                       .pColorAttachments = &reference};
    constexpr VkPipelineStageFlags kOutput = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
    const std::array dependencies{
        VkSubpassDependency{.srcSubpass = VK_SUBPASS_EXTERNAL,
                            .dstSubpass = 0,
                            .srcStageMask = VK_PIPELINE_STAGE_TRANSFER_BIT,
                            .dstStageMask = kOutput,
                            .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                            .dstAccessMask =
                                VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
        VkSubpassDependency{.srcSubpass = 0, // the semaphore makes the image visible to presentation
                            .dstSubpass = VK_SUBPASS_EXTERNAL,
                            .srcStageMask = kOutput,
                            .dstStageMask = VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT,
                            .srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT},
    };
    const VkRenderPassCreateInfo info{
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
        .attachmentCount = 1,
        .pAttachments = &attachment,
        .subpassCount = 1,
        .pSubpasses = &subpass,
        .dependencyCount = uint32_t(dependencies.size()),
        .pDependencies = dependencies.data(),
    };
    vulkanCheck(vkCreateRenderPass(device_.handle(), &info, nullptr, &overlay_pass_));
    device_.nameObject(VK_OBJECT_TYPE_RENDER_PASS, uint64_t(overlay_pass_), "swapchain.overlay");
}

bool Swapchain::resize(VkExtent2D wanted)
{
    device_.waitIdle();
    const auto caps = capabilities(device_, surface_);
    lost_ = !caps;
    if (lost_)
        return false;
    const VkExtent2D extent = imageExtent(*caps, wanted);
    if (extent.width == 0 || extent.height == 0)
        return false;
    const VkSwapchainCreateInfoKHR info{
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = surface_,
        .minImageCount = wantedImageCount(*caps),
        .imageFormat = format_,
        .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
        .imageExtent = extent,
        .imageArrayLayers = 1,
        .imageUsage = kUsage,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = caps->currentTransform,
        .compositeAlpha = compositeAlpha(*caps),
        .presentMode = VK_PRESENT_MODE_FIFO_KHR,
        .clipped = VK_TRUE,
        .oldSwapchain = swapchain_,
    };
    VkSwapchainKHR made = VK_NULL_HANDLE;
    vulkanCheck(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &made));
    destroyFrames();
    vkDestroySwapchainKHR(device_.handle(), std::exchange(swapchain_, made), nullptr);
    extent_ = extent;
    stale_ = false;

    uint32_t count = 0;
    vulkanCheck(vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, nullptr));
    std::vector<VkImage> images(count);
    vulkanCheck(vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, images.data()));
    for (const VkImage image : images)
        frames_.push_back(createFrame(image));
    return true;
}

Swapchain::Frame Swapchain::createFrame(VkImage image) const
{
    Frame frame{.image = image};
    device_.nameObject(VK_OBJECT_TYPE_IMAGE, uint64_t(image), "swapchain.image");
    const VkImageViewCreateInfo view{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                     .image = image,
                                     .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                     .format = format_,
                                     .subresourceRange = kWhole};
    vulkanCheck(vkCreateImageView(device_.handle(), &view, nullptr, &frame.view));
    const VkFramebufferCreateInfo framebuffer{.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
                                              .renderPass = overlay_pass_,
                                              .attachmentCount = 1,
                                              .pAttachments = &frame.view,
                                              .width = extent_.width,
                                              .height = extent_.height,
                                              .layers = 1};
    vulkanCheck(vkCreateFramebuffer(device_.handle(), &framebuffer, nullptr, &frame.framebuffer));
    frame.rendered = semaphore(device_);
    return frame;
}

void Swapchain::destroyFrames()
{
    for (const Frame& frame : frames_)
    {
        vkDestroyFramebuffer(device_.handle(), frame.framebuffer, nullptr);
        vkDestroyImageView(device_.handle(), frame.view, nullptr);
        vkDestroySemaphore(device_.handle(), frame.rendered, nullptr);
    }
    frames_.clear();
}

bool Swapchain::acquire()
{
    if (!swapchain_ || stale_)
        return false;
    turn_ = (turn_ + 1) % kFramesInFlight;
    const VkResult result =
        vkAcquireNextImageKHR(device_.handle(), swapchain_, UINT64_MAX, acquired_[turn_], VK_NULL_HANDLE, &current_);
    stale_ = result == VK_SUBOPTIMAL_KHR; // this image still is ours to show
    return fits(result);
}

void Swapchain::beginOverlay(VkCommandBuffer commands, const Buffer& pixels) const
{
    const VkMemoryBarrier2 written{
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
        .srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT,
    };
    const VkImageMemoryBarrier2 receive{
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, // chains to the wait for acquired()
        .dstStageMask = VK_PIPELINE_STAGE_2_TRANSFER_BIT,
        .dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
        .oldLayout = VK_IMAGE_LAYOUT_UNDEFINED,
        .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = frames_[current_].image,
        .subresourceRange = kWhole,
    };
    const VkDependencyInfo dependency{.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                      .memoryBarrierCount = 1,
                                      .pMemoryBarriers = &written,
                                      .imageMemoryBarrierCount = 1,
                                      .pImageMemoryBarriers = &receive};
    vkCmdPipelineBarrier2(commands, &dependency);
    const VkBufferImageCopy copy{.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                 .imageExtent = {extent_.width, extent_.height, 1}};
    vkCmdCopyBufferToImage(commands, pixels.handle(), frames_[current_].image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    const VkRenderPassBeginInfo begin{.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                      .renderPass = overlay_pass_,
                                      .framebuffer = frames_[current_].framebuffer,
                                      .renderArea = {{0, 0}, extent_}};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
}

void Swapchain::endOverlay(VkCommandBuffer commands) const
{
    vkCmdEndRenderPass(commands);
}

bool Swapchain::present()
{
    const VkPresentInfoKHR info{.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                                .waitSemaphoreCount = 1,
                                .pWaitSemaphores = &frames_[current_].rendered,
                                .swapchainCount = 1,
                                .pSwapchains = &swapchain_,
                                .pImageIndices = &current_};
    const VkResult result = vkQueuePresentKHR(device_.queue(), &info);
    return fits(result) && result != VK_SUBOPTIMAL_KHR;
}
