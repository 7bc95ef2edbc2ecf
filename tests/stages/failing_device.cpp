// Loaded before the Vulkan loader: a device that fails after N calls. LUMICUT_TEST_FAILURE is lost:N, memory:N,
// stuck:N, which also sends SIGTERM while the device works on forever, vanish:N, which empties the file LUMICUT_TEST_FILE at
// the Nth allocation, or full:N of writing to pictures' temporary files.
#include <vulkan/vulkan.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <string>
#include <unistd.h>

namespace
{
/// Whether the failure of that name comes now.
bool failsNow(const char* name, int& calls)
{
    const char* wanted = std::getenv("LUMICUT_TEST_FAILURE");
    const size_t length = std::strlen(name);
    return wanted != nullptr && std::strncmp(wanted, name, length) == 0 && wanted[length] == ':' &&
           calls++ >= std::atoi(wanted + length + 1);
}

template <typename Function>
Function next(const char* name)
{
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}
} // namespace

extern "C" VkResult vkWaitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all,
                                    uint64_t timeout)
{
    static int calls = 0, waits = 0;
    if (failsNow("stuck", waits))
    {
        kill(getpid(), SIGTERM);
        for (;;)
            pause();
    }
    const VkResult result = next<PFN_vkWaitForFences>("vkWaitForFences")(device, count, fences, all, timeout);
    return failsNow("lost", calls) ? VK_ERROR_DEVICE_LOST : result;
}

extern "C" VkResult vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                     const VkAllocationCallbacks* with, VkDeviceMemory* memory)
{
    static int calls = 0, vanished = 0;
    if (failsNow("vanish", vanished) && truncate(std::getenv("LUMICUT_TEST_FILE"), 0) != 0)
        std::abort();
    if (failsNow("memory", calls))
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return next<PFN_vkAllocateMemory>("vkAllocateMemory")(device, info, with, memory);
}

extern "C" ssize_t write(int file, const void* bytes, size_t count)
{
    static int calls = 0;
    char name[4096] = {};
    const std::string link = "/proc/self/fd/" + std::to_string(file);
    if (readlink(link.c_str(), name, sizeof(name) - 1) > 0 && std::strstr(name, ".exr.") != nullptr &&
        failsNow("full", calls))
    {
        errno = ENOSPC;
        return -1;
    }
    return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, count);
}
