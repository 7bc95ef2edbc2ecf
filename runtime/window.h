// A window on the desktop with its keyboard and mouse (GLFW). One at a time.
#pragma once
#include "runtime/fly_camera.h"
#include "runtime/gpu/instance.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

class Window
{
public:
    /// @param width, height of the part that shows the picture, in pixels where the desktop does not scale
    /// @return kDevice where there is no display, or none that Vulkan can show pictures on
    static Result<std::unique_ptr<Window>> open(const std::string& title, uint32_t width, uint32_t height);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What Instance::create() needs for createSurface().
    std::span<const char* const> instanceExtensions() const;
    /// The caller destroys it, before the window goes.
    VkSurfaceKHR createSurface(const Instance& instance) const;

    VkExtent2D size() const; // pixels; 0 x 0 while minimised
    float contentScale() const;
    GLFWwindow* handle() const { return window_; }

    /// Takes in what happened since the last call. With `wait`, sleeps until something happens.
    void poll(bool wait);
    bool closing() const;
    void close();
    /// Keys (GLFW_KEY_...) that went down since the last call, in order; none is lost however long a frame takes.
    std::vector<int> takeKeys();
    /// Keys held, mouse dragged and wheel turned since the last call. @param keyboard, mouse false: not meant for us
    FlyInput takeFlyInput(bool keyboard, bool mouse);

private:
    Window() = default;
    void listen();
    GLFWwindow* window_ = nullptr;
    std::vector<int> pressed_;
    double cursor_x_ = 0, cursor_y_ = 0, wheel_ = 0;
};
