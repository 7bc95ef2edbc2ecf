// Draws from a sampler as it runs on the device (tests/shaders/draw).
#pragma once
#include "tests/shaders/draw/draw.h"
#include "tests/stages/chi_squared.h"
#include "tests/stages/gpu_test.h"
#include "tests/stages/scene_builder.h"

#include <fmt/format.h>

#include <numbers>

std::span<const KernelCode> testKernelCodes();

class Sampling : public GpuTest
{
protected:
    static constexpr double kPi = std::numbers::pi;
    static constexpr uint32_t kDraws = 200000;

    static Kernel testKernel(std::string_view name, const SharedConstants& constants = {})
    {
        const auto code = std::ranges::find(testKernelCodes(), name, &KernelCode::name);
        check(code != testKernelCodes().end(), "there is no test kernel '{}'", name);
        return device().kernel(*code, constants);
    }

    /// `params.count` draws.
    template <typename Draw, typename Params>
    static std::vector<Draw> draw(const Kernel& kernel, const SceneGpu& scene, const Params& params)
    {
        const Buffer draws = device().array<Draw>("test.draws", params.count);
        Recorder rec(device());
        rec.begin(scene.descriptorSet());
        rec.run(kernel, params.count, params, {{"Draws", draws}});
        rec.submitAndWait();
        return device().download<Draw>(draws, params.count);
    }

    /// A scene that kernels bind and do not read.
    const SceneGpu& anyScene()
    {
        if (!any_scene_)
        {
            SceneBuilder builder;
            builder.floor(1, 0, builder.material(lambert(0.5)));
            any_scene_ = load(builder.compile());
        }
        return *any_scene_;
    }

private:
    std::unique_ptr<SceneGpu> any_scene_;
};

inline std::vector<double> times(double factor, std::vector<double> values)
{
    for (double& value : values)
        value *= factor;
    return values;
}
