// Traces queues of rays: the stage that every other stage traces with.
#pragma once
#include "runtime/gpu/gpu.h"
#include "runtime/scene_gpu.h"
#include "shaders/rays/rays.h"

/// A queue whose length is made on the GPU, with room for its indirect dispatch.
struct RayQueue
{
    RayQueue(const Device& device, std::string_view name, uint32_t capacity, const Scratch& scratch = {});
    Buffer size; // gpu::QueueSize
    Buffer rays; // gpu::Ray[capacity]
};

/// Seed of the stochastic alpha decisions of one dispatch: another for every pass over the same pixels.
uint32_t traceSeed(uint32_t seed, uint32_t sample, uint32_t depth);

/// Counts the rays of recorded frames by the scope they are traced in. For measurements: it costs a copy a queue.
class RayTally
{
public:
    explicit RayTally(const Device& device);

    struct Entry
    {
        std::string scope;
        bool any_hit; // shadow rays; else closest-hit rays
        uint64_t ray_count;
    };
    void note(Recorder& rec, const Buffer& queue_size, bool any_hit);
    void note(Recorder& rec, uint32_t ray_count);
    /// Everything noted and submitted so far, known counts first, else in order of first appearance; waits for the device.
    std::vector<Entry> entries() const;

private:
    const Device& device_;
    Buffer sizes_; // gpu::QueueSize, one for each of queues_
    std::vector<Entry> queues_;
    std::vector<Entry> known_; // by their count
};

class RayStage
{
public:
    RayStage(const Device& device, const SceneGpu& scene);

    /// Sets a queue's count to zero, before a kernel fills it.
    void reset(Recorder& rec, const Buffer& size) const { rec.clear(size); }
    /// Sets a queue's count from the CPU; the queue is then ready for dispatch.
    void resize(Recorder& rec, const Buffer& size, uint32_t count) const;
    /// Makes a queue that a kernel has filled ready for dispatch.
    void close(Recorder& rec, const Buffer& size) const;

    /// hits[i] becomes what rays[i] meets first. @param hits gpu::Hit[queue capacity]
    void closest(Recorder& rec, const RayQueue& queue, const Buffer& hits, uint32_t seed) const;
    /// radiance[path] grows by every shadow ray that arrives. One ray a path in the queue at most.
    /// @param shadow_rays gpu::ShadowRay[], @param radiance vec3[]
    void visible(Recorder& rec, const Buffer& size, const Buffer& shadow_rays, const Buffer& radiance) const;

    /// Notes rays that another stage traces itself. @param size gpu::QueueSize: their count
    void count(Recorder& rec, const Buffer& size, bool any_hit = false) const;
    void count(Recorder& rec, uint32_t ray_count) const;
    bool counts() const { return tally_ != nullptr; }
    /// Notes every queue that is traced from now on; null ends that.
    void countInto(RayTally* tally) { tally_ = tally; }

private:
    Kernel closest_, visible_, dispatch_size_, set_size_;
    RayTally* tally_ = nullptr;
};
