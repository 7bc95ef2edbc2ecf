// Dear ImGui over the picture: its lifetime, its input and its drawing.
#pragma once
#include "runtime/gpu/recorder.h"
#include "runtime/gpu/swapchain.h"
#include "runtime/window.h"

class WindowOverlay
{
public:
    WindowOverlay(const Window& window, const Instance& instance, const Device& device, const Swapchain& swapchain,
                  Recorder& rec);
    ~WindowOverlay();
    WindowOverlay(const WindowOverlay&) = delete;
    WindowOverlay& operator=(const WindowOverlay&) = delete;

    /// ImGui calls are allowed from here to draw().
    void begin();
    /// Inside the overlay pass.
    void draw(VkCommandBuffer commands);

    bool wantsKeyboard() const; // a text field has it
    bool wantsMouse() const;    // it is over the user interface, or was pressed there

private:
    const Device& device_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
};
