// The lights of a scene on the device, and as the CPU knows them: what changes one brings the tables up to date.
#pragma once
#include "format/light_table.h"
#include "runtime/gpu/gpu.h"
#include "shaders/lights/lights.h"

#include <optional>
#include <span>
#include <vector>

struct ChangedLight
{
    uint32_t index;
    gpu::Light light; // of the kind that it has; pmf is not read. One that emits nothing is as if it were not there
};

class SceneLights
{
public:
    SceneLights(const Device& device, const package::Package& package);

    /// By index, as they were set last; moving triangles as ChangedLight told.
    std::span<const gpu::Light> lights() const { return table_.lights(); }
    /// Grows when a pmf changes: tables made of them are out of date.
    uint64_t tableVersion() const { return table_version_; }

    /// From the next kernel of `rec` on lights are these, and are picked by the power that all have now. Corners of triangles
    /// tell their power only: on the device they follow geometry.
    /// @param changed each of another light, @param lights gpu::Light[], @param aliases gpu::AliasEntry[] of all
    void set(Recorder& rec, std::span<const ChangedLight> changed, const Buffer& lights, const Buffer& aliases);

private:
    package::LightTable table_;
    uint64_t table_version_ = 0;
    std::optional<Kernel> set_;      // where there are lights
    Buffer changes_, probabilities_; // gpu::SetLight[], float[], of all lights each
    std::vector<gpu::SetLight> written_;
    std::vector<float> pmfs_;
};
