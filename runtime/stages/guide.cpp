#include "runtime/stages/guide.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr uint32_t kManyLights = 4; // from here on some of them may be hidden; a quad lamp is two triangles, hence two lights

/// Scale of the fixed-point scores: as large as possible without overflow in a cell that all photons leave from.
float scoreScale(uint32_t photon_count)
{
    constexpr double kMostWeight = gpu::kGuideGroups / double(gpu::kGuideUnguided), kMostScale = 16;
    const double most = double(photon_count) * gpu::kGuideMostWanted * kMostWeight;
    const double scale = std::min(kMostScale, 4294967295.0 / most);
    return float(scale >= 1 ? std::floor(scale) : scale);
}

struct GuidedLights
{
    gpu::GuideGroups groups{};
    std::vector<float> other_lights; // cumulative fraction of power by light, without those that have a group of their own
};

GuidedLights groupsOf(std::span<const LightShare> lights)
{
    GuidedLights result;
    std::ranges::fill(result.groups.beam_lights, gpu::kNone);
    uint32_t beams = 0;
    double others = 0;
    for (uint32_t i = 0; i < lights.size(); ++i)
    {
        if (lights[i].isBeam() && beams < gpu::kGuideBeams)
        {
            result.groups.beam_lights[beams] = i;
            result.groups.shares[beams++] = lights[i].pmf;
        }
        else
            others += lights[i].pmf;
        result.other_lights.push_back(float(others));
    }
    result.groups.shares[gpu::kGuideBeams] = float(others);
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
    const auto lights = scene.lightShares();
    return lights.size() >= kManyLights || std::ranges::any_of(lights, &LightShare::isBeam);
}

GuideStage::GuideStage(const Device& device, const SceneGpu& scene, uint32_t max_paths)
    : emit_(device.kernel("guide/emit", scene.constants())), mark_(device.kernel("guide/mark", scene.constants())),
      score_(device.kernel("guide/score", scene.constants())), learn_(device.kernel("guide/learn")),
      distribution_(device.array<gpu::GuideDistribution>("guide.distribution", 1)),
      cells_(device.array<uint32_t>("guide.cells", max_paths)),
      wanted_(device.array<uint32_t>("guide.wanted", gpu::kGuidePlaces)),
      scores_(device.array<gpu::GuideScore>("guide.scores", gpu::kGuideTotal))
{
    const GuidedLights lights = groupsOf(scene.lightShares());
    groups_ = device.upload<gpu::GuideGroups>("guide.groups", std::span(&lights.groups, 1));
    other_lights_ = device.upload<float>("guide.other_lights", lights.other_lights);
}

void GuideStage::reset(Recorder& rec)
{
    has_learned_ = false;
    rec.clear(scores_);
    rec.clear(wanted_);
    rec.run(learn_, gpu::kGuideLearnSize, NoParams{},
            {{"Groups", groups_}, {"Scores", scores_}, {"Distribution", distribution_}});
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

void GuideStage::mark(Recorder& rec, const RayQueue& queue, uint32_t max_rays, const Buffer& hits,
                      bool more)
{
    if (!more)
        rec.clear(wanted_);
    rec.run(mark_, max_rays / gpu::kGuideMarkStride, NoParams{},
            {{"Queue", queue.size}, {"Rays", queue.rays}, {"Hits", hits}, {"Wanted", wanted_}});
}

void GuideStage::learn(Recorder& rec, const StoredPhotons& map)
{
    has_learned_ = true;
    rec.run(score_, map.path_count, gpu::ScoreParams{.scale = scoreScale(map.capacity)},
            {{"Groups", groups_},
             {"Distribution", distribution_},
             {"Cells", cells_},
             {"Photons", map.photons},
             {"Slots", map.slots},
             {"Offsets", map.offsets},
             {"Counts", map.counts},
             {"Store", map.store},
             {"Wanted", wanted_},
             {"Scores", scores_}});
    rec.run(learn_, gpu::kGuideLearnSize, NoParams{},
            {{"Groups", groups_}, {"Scores", scores_}, {"Distribution", distribution_}});
}
