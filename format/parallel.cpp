#include "format/parallel.h"

#include <algorithm>
#include <atomic>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace package
{
namespace
{
Status runOne(const std::function<Status()>& task)
{
    try
    {
        return task();
    }
    catch (const std::bad_alloc&)
    {
        return Error{ExitCode::kDevice, "there is not enough memory to open the package; close other programs"};
    }
}
} // namespace

Status runAll(std::span<const std::function<Status()>> tasks, bool parallel)
{
    std::vector<Status> results(tasks.size(), Success{});
    std::atomic<size_t> next = 0;
    const auto work = [&]
    {
        for (size_t i = next++; i < tasks.size(); i = next++)
            results[i] = runOne(tasks[i]);
    };

    std::vector<std::jthread> threads;
    const size_t thread_count = std::min<size_t>({tasks.size(), std::thread::hardware_concurrency(), 8});
    try
    {
        for (size_t i = 1; parallel && i < thread_count; ++i)
            threads.emplace_back(work);
    }
    catch (const std::system_error&)
    {
        // No more threads to be had: those that run, and this one, do the work.
    }
    work();
    threads.clear(); // joins

    for (Status& result : results)
    {
        if (!result)
            return std::move(result);
    }
    return Success{};
}
} // namespace package
