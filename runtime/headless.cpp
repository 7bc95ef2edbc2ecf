#include "runtime/headless.h"

#include "runtime/opened_scene.h"

#include <algorithm>

namespace
{
/// Renders all samples; at most `max_batch` a submission.
void renderSamples(const PlayerOptions& options, Renderer& renderer, const OpenedScene& opened, Statistics& statistics)
{
    Recorder rec(*opened.device);
    uint32_t left = options.sample_count > 0 ? options.sample_count : std::max(options.frame_count, 1u);
    while (left > 0)
    {
        const uint32_t count = options.mode == Mode::kReference ? std::min(left, renderer.maxBatch()) : 1;
        rec.begin(opened.scene->descriptorSet());
        {
            const auto scope = rec.scope("frame");
            renderer.record(rec, opened.camera, opened.settings, options.seed, count);
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
    const auto opened = openScene(options, {}, statistics);
    if (!opened)
        return opened.error();
    std::optional<Renderer> renderer;
    if (const Status status = makeRenderer(renderer, *opened, options.mode, options.width, options.height, opened->settings); !status)
        return status;
    statistics.pipeline_ms = opened->device->pipelineMs();
    renderSamples(options, *renderer, *opened, statistics);
    return writeResults(options, *opened, *renderer, opened->settings, statistics);
}
