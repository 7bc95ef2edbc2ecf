#include "runtime/stages/rays.h"

#include <algorithm>

RayQueue::RayQueue(const Device& device, std::string_view name, uint32_t capacity, const Scratch& scratch)
    : size(device.array<gpu::QueueSize>(fmt::format("{}.size", name), 1)),
      rays(device.texelArray<gpu::Ray>(fmt::format("{}.rays", name), capacity, scratch))
{
}

uint32_t traceSeed(uint32_t seed, uint32_t sample, uint32_t depth)
{
    uint32_t mixed = seed;
    for (const uint32_t value : {sample, depth})
        mixed = (mixed ^ value) * 0x9e3779b1u + 0x7f4a7c15u;
    return mixed;
}

namespace
{
constexpr uint32_t kMaxTallied = 4096; // queues
}

RayTally::RayTally(const Device& device)
    : device_(device), sizes_(device.array<gpu::QueueSize>("rays.tally", kMaxTallied))
{
}

void RayTally::note(Recorder& rec, const Buffer& queue_size, bool any_hit)
{
    check(queues_.size() < kMaxTallied, "more than {} queues are counted", kMaxTallied);
    rec.copy(queue_size, sizes_, sizeof(gpu::QueueSize), queues_.size() * sizeof(gpu::QueueSize));
    queues_.push_back({.scope = std::string(rec.scopeName()), .any_hit = any_hit, .ray_count = 0});
}

void RayTally::note(Recorder& rec, uint32_t ray_count)
{
    known_.push_back({.scope = std::string(rec.scopeName()), .any_hit = false, .ray_count = ray_count});
}

std::vector<RayTally::Entry> RayTally::entries() const
{
    const auto sizes =
        queues_.empty() ? std::vector<gpu::QueueSize>() : device_.download<gpu::QueueSize>(sizes_, queues_.size());
    std::vector<Entry> noted = known_;
    for (size_t i = 0; i < queues_.size(); ++i)
    {
        noted.push_back(queues_[i]);
        noted.back().ray_count = sizes[i].count;
    }
    std::vector<Entry> entries;
    for (const Entry& note : noted)
    {
        const auto entry = std::ranges::find_if(entries, [&](const Entry& e)
                                                { return e.scope == note.scope && e.any_hit == note.any_hit; });
        if (entry == entries.end())
            entries.push_back(note);
        else
            entry->ray_count += note.ray_count;
    }
    return entries;
}

RayStage::RayStage(const Device& device, const SceneGpu& scene)
    : closest_(device.kernel("rays/closest", scene.constants())),
      visible_(device.kernel("rays/visible", scene.constants())), dispatch_size_(device.kernel("rays/dispatch_size")),
      set_size_(device.kernel("rays/set_size"))
{
}

void RayStage::resize(Recorder& rec, const Buffer& size, uint32_t count) const
{
    rec.run(set_size_, 1, gpu::QueueParams{.count = count}, {{"Queue", size}});
}

void RayStage::close(Recorder& rec, const Buffer& size) const
{
    rec.run(dispatch_size_, 1, NoParams{}, {{"Queue", size}});
}

void RayStage::closest(Recorder& rec, const RayQueue& queue, const Buffer& hits, uint32_t seed) const
{
    if (tally_)
        tally_->note(rec, queue.size, false);
    rec.runIndirect(closest_, queue.size, gpu::RaysParams{.seed = seed},
                    {{"Queue", queue.size}, {"Rays", queue.rays}, {"Hits", hits}});
}

void RayStage::count(Recorder& rec, const Buffer& size, bool any_hit) const
{
    if (tally_)
        tally_->note(rec, size, any_hit);
}

void RayStage::count(Recorder& rec, uint32_t ray_count) const
{
    if (tally_)
        tally_->note(rec, ray_count);
}

void RayStage::visible(Recorder& rec, const Buffer& size, const Buffer& shadow_rays, const Buffer& radiance) const
{
    if (tally_)
        tally_->note(rec, size, true);
    rec.runIndirect(visible_, size, NoParams{}, {{"Queue", size}, {"ShadowRays", shadow_rays}, {"Radiance", radiance}});
}
