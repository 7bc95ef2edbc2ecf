#include "runtime/reference_part.h"

#include "image/picture_file.h"
#include "image/sample_sum.h"
#include "image/write_image.h"
#include "runtime/interruption.h"
#include "runtime/nearest_origin.h"
#include "runtime/stages/exact_sum.h"

#include <algorithm>
#include <cstring>

namespace
{
/// Whether the file is there with what this run would write. @return kInvalid, kIo where something else is there
Result<bool> isThere(const PlayerOptions& options)
{
    const PictureState state =
        options.force ? PictureState::kNone : pictureState(options.output, options.width, options.height);
    if (state == PictureState::kNone || state == PictureState::kIncomplete)
        return false;
    const std::string hint = "move it away, or give --force to replace it";
    if (state == PictureState::kOther)
        return Error{
            ExitCode::kIo,
            fmt::format("is there already and is no picture of {}x{} pixels; {}", options.width, options.height, hint),
            options.output.string()};
    const auto origin = readOrigin(options.output);
    const auto wanted = possibleOrigins(options);
    if (!origin)
        return origin.error().about(options.output.string());
    if (!wanted)
        return wanted.error();
    if (origin->samples != wanted->front().samples)
        return Error{
            ExitCode::kInvalid,
            fmt::format("is there already with {}; {}",
                        origin->samples.empty() ? "no sums of samples" : fmt::format("samples {}", origin->samples),
                        hint),
            options.output.string()};
    if (const std::string differing = nearestDifference(*origin, *wanted); !differing.empty())
        return Error{ExitCode::kInvalid, fmt::format("is there already and was rendered {}; {}", differing, hint),
                     options.output.string()};
    return true;
}

/// Traces the samples in the passes of a whole picture, however many of a pass are wanted: random numbers of its rays are
/// numbered from its start.
bool traceSamples(const OpenedScene& opened, const PlayerOptions& options, const ExactSumStage& sum,
                  Statistics& statistics)
{
    const uint32_t pixel_count = options.width * options.height;
    const uint32_t batch = Renderer::batchFor(*opened.device, pixel_count);
    const RayStage rays(*opened.device, *opened.scene);
    const ReferenceStage reference(*opened.device, *opened.scene, pixel_count, batch);
    Recorder rec(*opened.device);
    rec.timeScopes(!options.stats.empty());
    const uint32_t begin = options.samples->first, end = options.samples->last + 1;
    for (uint32_t first = begin / batch * batch; first < end; first += batch)
    {
        if (interruption() != 0)
            return false;
        rec.begin(opened.scene->descriptorSet());
        {
            const auto scope = rec.scope("frame");
            gpu::CameraParams camera =
                cameraParams(opened.pose(rec, options.seconds.value_or(0)), options.width, options.height);
            camera.seed = options.seed;
            camera.first_sample = first;
            camera.sample_count = std::min(batch, end - first);
            if (first <= begin)
                sum.clear(rec);
            const Buffer& radiance = reference.record(
                rec, rays,
                {.camera = camera, .depth_limit = opened.settings.reference_depth, .term = opened.settings.term});
            sum.record(rec, radiance, std::max(begin, first) - first, camera.sample_count);
        }
        if (statistics.frames.empty())
            statistics.noteFirstSubmit(*opened.device);
        statistics.addFrame(rec.submitAndWait());
    }
    statistics.sample_count = options.samples->count();
    return true;
}

SampleSum downloaded(const OpenedScene& opened, const PlayerOptions& options, const ExactSumStage& stage)
{
    SampleSum sum{.width = options.width,
                  .height = options.height,
                  .sums = std::vector<Int128>(3 * size_t(options.width) * options.height),
                  .samples = {{options.samples->first, options.samples->last}},
                  .origin = {}};
    static_assert(gpu::kExactWords * sizeof(uint32_t) == sizeof(Int128) && gpu::kExactUnitBits == 64);
    const auto words = opened.device->download<uint32_t>(stage.sums(), gpu::kExactWords * sum.sums.size());
    std::memcpy(sum.sums.data(), words.data(), words.size() * sizeof(uint32_t));
    return sum;
}
} // namespace

Status playReferencePart(const PlayerOptions& options)
{
    noteInterruptions();
    Statistics statistics;
    const auto there = isThere(options);
    if (!there)
        return there.error();
    if (*there)
    {
        fmt::print(stderr, "{} is there; --force renders it again\n", options.output.string());
        return Success{};
    }
    if (const Status status = canWriteFile(options.output); !status)
        return status.error().about(options.output.string());
    const auto opened = openScene(options, {}, statistics);
    if (!opened)
        return opened.error();
    if (const Status status = Renderer::checkSize(*opened->device, options.width, options.height); !status)
        return status;
    const ExactSumStage stage(*opened->device, options.width * options.height);
    const double start = statistics.elapsedMs() - opened->device->pipelineMs();
    if (!traceSamples(*opened, options, stage, statistics))
        return Error{ExitCode(128 + interruption()),
                     fmt::format("ended by a signal ({}), and nothing is written", ::strsignal(interruption()))};
    statistics.non_finite_samples = opened->device->download<uint32_t>(stage.nonFiniteCount(), 1)[0];
    statistics.device = opened->device->name();
    statistics.device_bytes = opened->device->allocatedBytes();
    fmt::print(stderr, "{}\n", statistics.summary());
    SampleSum sum = downloaded(*opened, options, stage);
    auto origin = originOf(*opened, options);
    if (!origin)
        return origin.error();
    sum.origin = std::move(*origin);
    if (const Status status = writeSampleSum(options.output, sum); !status)
        return status.error().about(options.output.string());
    statistics.frames_written = 1;
    statistics.frames_ms =
        statistics.elapsedMs() - opened->device->pipelineMs() - start; // waiting for them: the start's
    if (options.stats.empty())
        return Success{};
    const Status status = statistics.writeJson(options.stats);
    return status ? status : status.error().about(options.stats.string());
}
