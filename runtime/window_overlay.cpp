#include "runtime/window_overlay.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

namespace
{
void mustSucceed(VkResult result)
{
    vulkanCheck(result);
}
} // namespace

WindowOverlay::WindowOverlay(const Window& window, const Instance& instance, const Device& device,
                             const Swapchain& swapchain, Recorder& rec)
    : device_(device)
{
    constexpr VkDescriptorPoolSize kFont{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    const VkDescriptorPoolCreateInfo pool{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                          .flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT,
                                          .maxSets = 1,
                                          .poolSizeCount = 1,
                                          .pPoolSizes = &kFont};
    vulkanCheck(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_));

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr; // write no layout file
    io.FontGlobalScale = window.contentScale();
    ImGui::GetStyle().ScaleAllSizes(window.contentScale());
    ImGui_ImplGlfw_InitForVulkan(window.handle(), true); // calls the window's own callbacks too
    ImGui_ImplVulkan_InitInfo info{
        .Instance = instance.handle(),
        .PhysicalDevice = device.physical(),
        .Device = device.handle(),
        .QueueFamily = device.queueFamily(),
        .Queue = device.queue(),
        .DescriptorPool = pool_,
        .MinImageCount = 2,
        .ImageCount = std::max(swapchain.imageCount(), 2u), // sets of vertex buffers, used in turn
        .MSAASamples = VK_SAMPLE_COUNT_1_BIT,
        .CheckVkResultFn = mustSucceed,
    };
    ImGui_ImplVulkan_Init(&info, swapchain.overlayPass());
    rec.begin();
    ImGui_ImplVulkan_CreateFontsTexture(rec.commands());
    rec.submitAndWait();
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

WindowOverlay::~WindowOverlay()
{
    device_.waitIdle();
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
}

void WindowOverlay::begin()
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void WindowOverlay::draw(VkCommandBuffer commands)
{
    ImGui::Render();
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

bool WindowOverlay::wantsKeyboard() const
{
    return ImGui::GetIO().WantTextInput;
}

bool WindowOverlay::wantsMouse() const
{
    return ImGui::GetIO().WantCaptureMouse;
}
