#include "runtime/headless.h"

#include "runtime/interruption.h"

#include <algorithm>

bool renderSamples(Recorder& rec, Renderer& renderer, const OpenedScene& opened, const Moment& moment, uint32_t seed,
                   uint32_t sample_count, Statistics& statistics)
{
    while (sample_count > 0 && interruption() == 0)
    {
        const uint32_t batch = std::min(sample_count, renderer.maxBatch());
        rec.begin(opened.scene->descriptorSet());
        {
            const auto scope = rec.scope("frame");
            const Camera posed = opened.pose(rec, moment.seconds);
            renderer.record(rec, moment.camera.value_or(posed), opened.settings, seed, batch);
        }
        if (statistics.frames.empty())
            statistics.noteFirstSubmit(*opened.device);
        statistics.addFrame(rec.submitAndWait());
        sample_count -= batch;
    }
    return sample_count == 0;
}

Status playHeadless(const PlayerOptions& options)
{
    Statistics statistics;
    const auto opened = openScene(options, {}, statistics);
    if (!opened)
        return opened.error();
    std::optional<Renderer> renderer;
    if (const Status status = makeRenderer(renderer, *opened, options.mode, options.width, options.height,
                                           opened->settings, !options.layers.empty());
        !status)
        return status;
    Recorder rec(*opened->device);
    rec.timeScopes(!options.stats.empty());
    const uint32_t sample_count = options.sample_count > 0 ? options.sample_count : std::max(options.frame_count, 1u);
    renderSamples(rec, *renderer, *opened, {.seconds = options.seconds.value_or(0)}, options.seed, sample_count,
                  statistics);
    return writeResults(options, *opened, *renderer, opened->settings, statistics);
}
