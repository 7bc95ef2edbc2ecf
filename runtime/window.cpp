#include "runtime/window.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace
{
Error noDisplay(const char* fallback)
{
    const char* reason = nullptr;
    glfwGetError(&reason);
    return {ExitCode::kDevice,
            fmt::format("there is no display to open a window on ({}); --headless --output picture.png "
                        "renders to a file",
                        reason ? reason : fallback)};
}
} // namespace

Result<std::unique_ptr<Window>> Window::open(const std::string& title, uint32_t width, uint32_t height)
{
    if (!glfwInit())
        return noDisplay("the window library cannot start");
    std::unique_ptr<Window> window(new Window);
    if (!glfwVulkanSupported())
        return noDisplay("Vulkan cannot show pictures here");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->window_ = glfwCreateWindow(int(width), int(height), title.c_str(), nullptr, nullptr);
    if (!window->window_)
        return noDisplay("no window can be created");
    window->listen();
    return window;
}

void Window::listen()
{
    glfwSetWindowUserPointer(window_, this);
    glfwSetInputMode(window_, GLFW_STICKY_KEYS, GLFW_TRUE); // a short tap counts, however long a frame takes
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* handle, int key, int, int action, int)
                       {
                           if (action == GLFW_PRESS)
                               static_cast<Window*>(glfwGetWindowUserPointer(handle))->pressed_.push_back(key);
                       });
    glfwSetScrollCallback(window_, [](GLFWwindow* handle, double, double notches)
                          { static_cast<Window*>(glfwGetWindowUserPointer(handle))->wheel_ += notches; });
    glfwGetCursorPos(window_, &cursor_x_, &cursor_y_);
}

Window::~Window()
{
    if (window_)
        glfwDestroyWindow(window_);
    glfwTerminate();
}

std::span<const char* const> Window::instanceExtensions() const
{
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    return {names, count};
}

VkSurfaceKHR Window::createSurface(const Instance& instance) const
{
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    vulkanCheck(glfwCreateWindowSurface(instance.handle(), window_, nullptr, &surface));
    return surface;
}

VkExtent2D Window::size() const
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {uint32_t(width), uint32_t(height)};
}

float Window::contentScale() const
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return std::max(x, 1.0f);
}

void Window::poll(bool wait)
{
    if (wait)
        glfwWaitEvents();
    else
        glfwPollEvents();
}

bool Window::closing() const
{
    return glfwWindowShouldClose(window_);
}

void Window::close()
{
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

std::vector<int> Window::takeKeys()
{
    return std::exchange(pressed_, {});
}

FlyInput Window::takeFlyInput(bool keyboard, bool mouse)
{
    const double last_x = std::exchange(cursor_x_, 0), last_y = std::exchange(cursor_y_, 0),
                 wheel = std::exchange(wheel_, 0);
    glfwGetCursorPos(window_, &cursor_x_, &cursor_y_);

    FlyInput input;
    if (keyboard)
    {
        const auto held = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0f : 0.0f; };
        input.right = held(GLFW_KEY_D) - held(GLFW_KEY_A);
        input.up = held(GLFW_KEY_E) - held(GLFW_KEY_Q);
        input.forward = held(GLFW_KEY_W) - held(GLFW_KEY_S);
        input.fast = held(GLFW_KEY_LEFT_SHIFT) + held(GLFW_KEY_RIGHT_SHIFT) > 0;
    }
    const bool dragging = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS ||
                          glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
    if (mouse && dragging)
    {
        int width = 0, height = 0; // of the window, in the cursor's unit
        glfwGetWindowSize(window_, &width, &height);
        const float radians =
            std::numbers::pi_v<float> / float(std::max(height, 1)); // half a turn over the window's height
        input.yaw = float(last_x - cursor_x_) * radians;
        input.pitch = float(last_y - cursor_y_) * radians;
    }
    if (mouse)
        input.faster = float(wheel);
    return input;
}
