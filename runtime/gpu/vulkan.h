// The one place that includes Vulkan, and what to do when a call fails that must not.
#pragma once
#include "format/check.h"

#include <vulkan/vulkan.h>

/// Name of a VkResult for messages, such as "VK_ERROR_DEVICE_LOST".
const char* vulkanResultName(VkResult result);

/// Aborts unless `call` succeeds: for calls that only fail through a bug of ours or a lost device.
#define vulkanCheck(call) \
    do \
    { \
        const VkResult vulkan_result_ = (call); \
        check(vulkan_result_ >= 0, "{}", vulkanResultName(vulkan_result_)); \
    } while (false)
