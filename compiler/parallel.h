// Runs independent pieces of work on several threads; results go into slots, so that the order never shows.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

/// Threads that parallelFor() takes, itself included, where this thread calls it.
inline thread_local unsigned thread_limit = std::max(1u, std::thread::hardware_concurrency());

/// Calls body(0) .. body(count - 1), each once, from several threads; rethrows the first exception of a third party.
template <typename Body>
void parallelFor(size_t count, const Body& body)
{
    std::atomic<size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto work = [&]
    {
        for (size_t i; (i = next.fetch_add(1)) < count;)
        {
            try
            {
                body(i);
            }
            catch (...)
            {
                const std::lock_guard lock(failure_mutex);
                failure = std::current_exception();
            }
        }
    };
    const size_t thread_count = std::min<size_t>(thread_limit, count);
    std::vector<std::thread> threads;
    for (size_t i = 1; i < thread_count; ++i)
        threads.emplace_back(
            [&work]
            {
                thread_limit = 1;
                work();
            });
    work();
    for (std::thread& thread : threads)
        thread.join();
    if (failure)
        std::rethrow_exception(failure);
}
