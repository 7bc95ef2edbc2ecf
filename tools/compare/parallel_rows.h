// Splits the rows of an image over the machine's cores.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

/// Calls `rows(first, last)` on every band of rows in 0..row_count-1, several bands at a time; returns when all are
/// done. Bands are disjoint; `rows` must not throw and must write nothing that two bands share.
template <typename Rows>
void parallelRows(uint32_t row_count, const Rows& rows)
{
    constexpr uint32_t kBand = 16;
    std::atomic<uint32_t> next{0};
    const auto work = [&]
    {
        for (uint32_t first = next.fetch_add(kBand); first < row_count; first = next.fetch_add(kBand))
            rows(first, std::min(first + kBand, row_count));
    };
    const uint32_t band_count = (row_count + kBand - 1) / kBand;
    const uint32_t thread_count = std::clamp(std::thread::hardware_concurrency(), 1u, std::max(band_count, 1u));
    std::vector<std::thread> helpers;
    for (uint32_t i = 1; i < thread_count; ++i)
        helpers.emplace_back(work);
    work();
    for (std::thread& helper : helpers)
        helper.join();
}
