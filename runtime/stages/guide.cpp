#include "runtime/stages/guide.h"

#include "runtime/light_groups.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr uint32_t kManyLights =
    4; // from here on some of them may be hidden; a quad lamp is two triangles, hence two lights

/// Scale of the fixed-point estimates: as large as possible without overflow in a cell that all paths leave from, each of
/// which adds 1 at most.
float estimateScale(uint32_t path_count)
{
    return float(std::ldexp(1.0, 62) / path_count);
}

bool isInfinite(const gpu::Light& light)
{
    return lightKind(light) != LightKind::kLocal;
}

struct GuidedLights
{
    gpu::GuideGroups groups{};
    std::vector<float>
        other_lights; // cumulative fraction of power by light, without those that have a group of their own
};

GuidedLights groupsOf(std::span<const gpu::Light> lights)
{
    GuidedLights result;
    std::ranges::fill(result.groups.infinite_lights, gpu::kNone);
    uint32_t beams = 0;
    double others = 0;
    for (uint32_t i = 0; i < lights.size(); ++i)
    {
        if (isInfinite(lights[i]) && beams < gpu::kGuideInfiniteLights)
        {
            result.groups.infinite_lights[beams] = i;
            result.groups.shares[beams++] = lights[i].pmf;
        }
        else
            others += lights[i].pmf;
        result.other_lights.push_back(float(others));
    }
    result.groups.shares[gpu::kGuideInfiniteLights] = float(others);
    const auto groups = std::ranges::count_if(result.groups.shares, [](float share) { return share > 0; });
    for (uint32_t g = 0; g < gpu::kGuideGroups; ++g)
        result.groups.unlearned[g] = result.groups.shares[g] > 0 ? 1.0f / float(groups) : 0;
    if (result.other_lights.empty())
        result.other_lights.push_back(0);
    return result;
}
} // namespace

bool GuideStage::helps(const SceneGpu& scene)
{
    return scene.lights().size() >= kManyLights || std::ranges::any_of(scene.lights(), isInfinite);
}

GuideStage::GuideStage(const Device& device, const SceneGpu& scene, uint32_t max_paths)
    : scene_(scene), table_version_(scene.lightTableVersion()),
      emit_(device.kernel("guide/emit", scene.transportConstants())),
      splat_(device.kernel("guide/splat", scene.transportConstants())),
      value_(device.kernel("guide/value", scene.transportConstants())), estimate_(device.kernel("guide/estimate")),
      fade_(device.kernel("guide/fade")), learn_(device.kernel("guide/learn")),
      distribution_(device.array<gpu::GuideDistribution>("guide.distribution", 1)),
      cells_(device.array<uint32_t>("guide.cells", max_paths)),
      importance_(device.array<uint32_t>("guide.importance", gpu::kGuideBins)),
      values_(device.array<float>("guide.values", max_paths)), largest_(device.array<uint32_t>("guide.largest", 1)),
      estimates_(device.array<gpu::GuideEstimate>("guide.estimates", gpu::kGuideTotal)),
      roots_(device.array<float>("guide.roots", gpu::kGuideTotal)), max_paths_(max_paths)
{
    const GuidedLights lights = groupsOf(scene.lights());
    groups_ = device.upload<gpu::GuideGroups>("guide.groups", std::span(&lights.groups, 1));
    other_lights_ = device.upload<float>("guide.other_lights", lights.other_lights);
}

void GuideStage::followLights(Recorder& rec)
{
    if (table_version_ == scene_.lightTableVersion())
        return;
    table_version_ = scene_.lightTableVersion();
    const GuidedLights lights = groupsOf(scene_.lights());
    rec.write(groups_, 0, std::as_bytes(std::span(&lights.groups, 1)));
    rec.write(other_lights_, 0, std::as_bytes(std::span(lights.other_lights)));
    runLearn(rec, 1); // a group that had no light may have some now
}

void GuideStage::reset(Recorder& rec)
{
    followLights(rec);
    has_learned_ = false;
    rec.clear(estimates_);
    rec.clear(importance_);
    rec.clear(largest_);
    runLearn(rec, 0);
}

void GuideStage::runLearn(Recorder& rec, float memory) const
{
    rec.run(fade_, gpu::kGuideTotal, gpu::FadeParams{.memory = memory, .scale = estimateScale(max_paths_)},
            {{"Largest", largest_}, {"Estimates", estimates_}, {"Roots", roots_}});
    rec.run(learn_, gpu::kGuideLearnSize, NoParams{},
            {{"Groups", groups_}, {"Roots", roots_}, {"Distribution", distribution_}});
}

void GuideStage::emit(Recorder& rec, const Buffer& starts, const gpu::EmitParams& params) const
{
    rec.run(emit_, params.path_count, params,
            {{"Groups", groups_},
             {"Distribution", distribution_},
             {"OtherLights", other_lights_},
             {"Starts", starts},
             {"Cells", cells_}});
}

void GuideStage::splat(Recorder& rec, const RayQueue& queue, uint32_t max_rays, const Buffer& hits, bool more)
{
    if (!more)
        rec.clear(importance_);
    rec.run(splat_, max_rays / gpu::kGuideSplatStride, NoParams{},
            {{"Queue", queue.size}, {"Rays", queue.rays}, {"Hits", hits}, {"Importance", importance_}});
}

void GuideStage::learn(Recorder& rec, const StoredPhotons& map)
{
    has_learned_ = true;
    rec.clear(largest_);
    rec.run(value_, map.path_count, NoParams{},
            {{"Photons", map.photons},
             {"Slots", map.slots},
             {"Offsets", map.offsets},
             {"Counts", map.counts},
             {"Store", map.store},
             {"Importance", importance_},
             {"Values", values_},
             {"Largest", largest_}});
    rec.run(estimate_, map.path_count, gpu::EstimateParams{.scale = estimateScale(max_paths_)},
            {{"Distribution", distribution_},
             {"Cells", cells_},
             {"Store", map.store},
             {"Values", values_},
             {"Largest", largest_},
             {"Estimates", estimates_}});
    runLearn(rec, gpu::kGuideMemory);
}
