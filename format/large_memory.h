// Memory for arrays of megabytes: in huge pages, which cost a 512th of the page faults and few misses of the TLB.
#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <vector>

/// Advises the kernel to use huge pages where `bytes` of untouched memory at `start` span any.
inline void preferHugePages(void* start, size_t bytes)
{
    constexpr uintptr_t kHugePage = uintptr_t(2) << 20;
    const uintptr_t from = (reinterpret_cast<uintptr_t>(start) + kHugePage - 1) / kHugePage * kHugePage;
    const uintptr_t to = (reinterpret_cast<uintptr_t>(start) + bytes) / kHugePage * kHugePage;
    if (from < to)
        madvise(reinterpret_cast<void*>(from), to - from, MADV_HUGEPAGE);
}

/// reserve() for a vector that is empty still.
template <typename T>
void reserveLarge(std::vector<T>& array, size_t count)
{
    array.reserve(count);
    preferHugePages(array.data(), count * sizeof(T));
}
