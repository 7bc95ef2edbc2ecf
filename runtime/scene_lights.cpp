#include "runtime/scene_lights.h"

#include <algorithm>

SceneLights::SceneLights(const Device& device, const package::Package& package) : table_(package)
{
    if (lights().empty())
        return;
    set_ = device.kernel("lights/set");
    changes_ = device.array<gpu::SetLight>("scene.set_lights", lights().size());
    probabilities_ = device.array<float>("scene.light_probabilities", lights().size());
}

void SceneLights::set(Recorder& rec, std::span<const ChangedLight> changed, const Buffer& lights, const Buffer& aliases)
{
    if (changed.empty())
        return;
    written_.clear();
    for (const auto& [index, light] : changed)
    {
        table_.set(index, light);
        written_.push_back(
            {.light = index, .emission = light.emission, .p0 = light.p0, .p1 = light.p1, .p2 = light.p2});
    }
    pmfs_.clear();
    if (table_.rebuild())
    {
        ++table_version_;
        for (const gpu::Light& light : table_.lights())
            pmfs_.push_back(light.pmf);
        rec.write(probabilities_, 0, std::as_bytes(std::span(pmfs_)));
        rec.write(aliases, 0, std::as_bytes(table_.aliases()));
    }
    rec.write(changes_, 0, std::as_bytes(std::span(written_)));
    const gpu::SetLightsParams params{.change_count = uint32_t(written_.size()), .pmf_count = uint32_t(pmfs_.size())};
    rec.run(*set_, std::max(params.change_count, params.pmf_count), params,
            {{"Changes", changes_}, {"Probabilities", probabilities_}, {"Lights", lights}});
}
