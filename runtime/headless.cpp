#include "runtime/headless.h"

#include "runtime/capture.h"
#include "runtime/statistics.h"

#include <algorithm>

namespace
{
/// Renders all samples; at most `max_batch` a submission.
void renderSamples(const PlayerOptions& options, Renderer& renderer, const Camera& camera, Recorder& rec, const SceneGpu& scene,
                   Statistics& statistics)
{
    uint32_t left = options.sample_count > 0 ? options.sample_count : std::max(options.frame_count, 1u);
    while (left > 0)
    {
        const uint32_t count = options.mode == Mode::kReference ? std::min(left, renderer.maxBatch()) : 1;
        rec.begin(scene.descriptorSet());
        {
            const auto scope = rec.scope("frame");
            renderer.record(rec, camera, options.settings, options.seed, count);
        }
        if (statistics.frames.empty())
            statistics.first_submit_ms = statistics.elapsedMs();
        statistics.addFrame(rec.submitAndWait());
        left -= count;
    }
}
} // namespace

Status playHeadless(const PlayerOptions& options)
{
    Statistics statistics;
    auto package = package::Package::open(options.package);
    if (!package)
        return package.error();
    statistics.open_ms = statistics.elapsedMs();

    auto instance = Instance::create({.validation = options.validation});
    if (!instance)
        return instance.error();
    const auto index = selectDevice(instance->devices(), options.device);
    if (!index)
        return index.error();
    auto device = Device::create(*instance, *index, false);
    if (!device)
        return device.error();
    const auto camera = chooseCamera(*package, options.camera);
    if (!camera)
        return camera.error();
    auto scene = SceneGpu::create(**device, *package);
    if (!scene)
        return scene.error();

    Renderer renderer(**device, **scene, options.mode, options.width, options.height);
    Recorder rec(**device);
    statistics.pipeline_ms = (*device)->pipelineMs();
    renderSamples(options, renderer, *camera, rec, **scene, statistics);

    statistics.device = (*device)->name();
    statistics.device_bytes = (*device)->allocatedBytes();
    statistics.sample_count = renderer.sampleCount();
    statistics.non_finite_samples = renderer.nonFiniteCount(**device);
    fmt::print(stderr, "{}\n", statistics.summary());
    if (!options.output.empty())
        if (const Status status = capture(options.output, renderer, **device, **scene, options.settings); !status)
            return status;
    if (!options.stats.empty())
        return statistics.writeJson(options.stats);
    return Success{};
}
