// Builds compute pipelines side by side: a driver takes a thread of its own for each, and some take a second for one.
#pragma once
#include "runtime/gpu/kernel.h"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

class Device;

/// Threads, at most one a core, that build pipelines in the order in which they were asked for. A failure in them ends the program
/// as one in the caller would (vulkanCheck). One thread at a time may call.
class PipelineBuilder
{
public:
    using ConstantValue = std::pair<uint32_t, uint32_t>; // id, value

    /// @param device is borrowed
    PipelineBuilder(const Device& device, VkPipelineCache cache) : device_(device), cache_(cache) {}
    ~PipelineBuilder() { stop(); }
    PipelineBuilder(const PipelineBuilder&) = delete;
    PipelineBuilder& operator=(const PipelineBuilder&) = delete;

    /// Returns at once. @param state with everything but its pipeline, which wait() gives
    void build(std::shared_ptr<Kernel::State> state, std::vector<ConstantValue> constants);
    VkPipeline wait(const Kernel::State& state);
    /// Waits for what is being built, and leaves out what has not been begun. No other call may follow.
    void stop();
    /// Milliseconds that wait() has taken so far.
    double waitedMs() const { return waited_ms_; }

private:
    struct Order
    {
        std::shared_ptr<Kernel::State> state;
        std::vector<ConstantValue> constants;
    };
    void work();
    VkPipeline create(const Order& order) const;

    const Device& device_;
    VkPipelineCache cache_;
    double waited_ms_ = 0;

    std::mutex mutex_; // of what follows, and of the pipelines
    std::condition_variable ordered_, built_;
    std::deque<Order> orders_; // not begun
    size_t idle_count_ = 0;    // threads that wait for orders
    bool ends_ = false;
    std::vector<std::thread> threads_;
};
