// The images a window shows, from a picture in a buffer to the screen.
#pragma once
#include "runtime/gpu/recorder.h"

#include <array>

/// kFramesInFlight frames are in flight at most: the caller waits for the frame that many before, before it calls acquire().
class Swapchain
{
public:
    /// Takes over `surface`, which is destroyed with this object or on failure.
    /// @return kDevice where the device cannot show 8-bit pictures on it
    static Result<std::unique_ptr<Swapchain>> create(const Instance& instance, const Device& device,
                                                     VkSurfaceKHR surface);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Makes the images anew, as large as the surface, or as `wanted` where that leaves the choice.
    /// @return false while the surface has no area
    bool resize(VkExtent2D wanted);
    /// The window is gone, by another's hand: nothing can be shown any more.
    bool lost() const { return lost_; }
    VkExtent2D extent() const { return extent_; } // pixels
    bool bgra() const { return format_ == VK_FORMAT_B8G8R8A8_UNORM; }
    uint32_t imageCount() const { return uint32_t(frames_.size()); }
    /// One subpass with one colour attachment, drawn over the picture.
    VkRenderPass overlayPass() const { return overlay_pass_; }

    /// Takes the next image. @return false where the images no longer fit the surface: resize()
    bool acquire();
    /// Copies packed pixels, uint[extent.width * extent.height], written by a kernel in the same command buffer, into
    /// the acquired image and begins the overlay pass on it.
    void beginOverlay(VkCommandBuffer commands, const Buffer& pixels) const;
    void endOverlay(VkCommandBuffer commands) const;
    VkSemaphore acquired() const { return acquired_[turn_]; }
    VkSemaphore rendered() const { return frames_[current_].rendered; }
    /// Shows the acquired image once rendered() is signalled. @return false as acquire()
    bool present();

private:
    struct Frame
    {
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFramebuffer framebuffer = VK_NULL_HANDLE;
        VkSemaphore rendered =
            VK_NULL_HANDLE; // an image's own: only its next acquire says that presenting waited for it
    };
    Swapchain(const Instance& instance, const Device& device, VkSurfaceKHR surface);
    Status choose();
    bool fits(VkResult result);
    void createOverlayPass();
    Frame createFrame(VkImage image) const;
    void destroyFrames();

    Instance instance_;
    const Device& device_;
    VkSurfaceKHR surface_;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkRenderPass overlay_pass_ = VK_NULL_HANDLE;
    std::array<VkSemaphore, kFramesInFlight> acquired_{}; // used in turn
    uint32_t turn_ = 0;
    std::vector<Frame> frames_;
    uint32_t current_ = 0;
    bool stale_ = false;
    bool lost_ = false;
};
