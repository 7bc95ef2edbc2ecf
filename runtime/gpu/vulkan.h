// The one place that includes Vulkan, and what to do when a call fails that must not.
#pragma once
#include "format/check.h"
#include "format/result.h"

#include <vulkan/vulkan.h>

#include <string>

/// Name of a VkResult for messages, such as "VK_ERROR_DEVICE_LOST".
const char* vulkanResultName(VkResult result);

/// EX_TEMPFAIL of sysexits.h: the device was lost or its memory full; the same command may succeed later, or elsewhere.
inline constexpr auto kTryAgain = ExitCode(75);

/// Whether it is the device that failed, not the call: it is lost, or memory is full.
bool isDeviceFailure(VkResult result);

/// Ends the program with kTryAgain, and at once: nothing can be asked of a lost device any more. @param what a sentence's beginning
[[noreturn]] void endForAnotherTry(const std::string& what);

/// Aborts unless `call` succeeds, for calls that only fail through a bug of ours or a failing device: of that, with kTryAgain.
#define vulkanCheck(call) \
    do \
    { \
        const VkResult vulkan_result_ = (call); \
        if (isDeviceFailure(vulkan_result_)) \
            endForAnotherTry(vulkanResultName(vulkan_result_)); \
        check(vulkan_result_ >= 0, "{}", vulkanResultName(vulkan_result_)); \
    } while (false)
