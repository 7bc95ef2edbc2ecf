#include "runtime/sequence.h"

#include "runtime/capture.h"
#include "runtime/frame_files.h"
#include "runtime/frame_seed.h"
#include "runtime/headless.h"
#include "runtime/interruption.h"
#include "runtime/opened_scene.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace
{
/// Renders frames of one sequence.
class Sequence
{
public:
    /// @param frame_count that render() will be given
    Sequence(const PlayerOptions& options, const OpenedScene& opened, const FrameFiles& files, size_t frame_count,
             const SequenceParts& parts, Statistics& statistics)
        : options_(options), opened_(opened), files_(files), frame_count_(frame_count), parts_(parts),
          statistics_(statistics), rec_(*opened.device)
    {
    }

    /// @param frames ascending
    Status render(std::span<const uint32_t> frames);
    /// Nothing where not even a renderer could be made.
    Status writeResults();

private:
    Status begin();
    Status renderPart(std::span<const uint32_t> frames);
    Status renderStanding(uint32_t frame);
    Status renderSamples(int64_t frame, uint32_t sample_count);
    Status write(uint32_t frame);

    const PlayerOptions& options_;
    const OpenedScene& opened_;
    const FrameFiles& files_;
    size_t frame_count_, written_ = 0; // that are to be written, and are
    SequenceParts parts_;
    Statistics& statistics_;
    Recorder rec_;
    std::optional<Renderer> renderer_;
};

/// A renderer that remembers nothing.
Status Sequence::begin()
{
    if (const Status status = makeRenderer(renderer_, opened_, options_.mode, options_.width, options_.height,
                                           opened_.settings, !options_.layers.empty());
        !status)
        return status;
    statistics_.pipeline_ms = opened_.device->pipelineMs();
    return Success{};
}

Status Sequence::renderSamples(int64_t frame, uint32_t sample_count)
{
    const double seconds = double(frame) / options_.fps;
    const Moment moment{.seconds = opened_.animationTime(options_.seconds.value_or(0) + seconds),
                        .camera = opened_.path ? std::optional(opened_.path->at(seconds)) : std::nullopt};
    if (::renderSamples(rec_, *renderer_, opened_, moment, frameSeed(options_.seed, frame), sample_count, statistics_))
        return Success{};
    return Error{ExitCode(128 + interruption()),
                 fmt::format("ended by a signal ({}) with {} of {} frames written; the same command renders the others",
                             ::strsignal(interruption()), written_, frame_count_)};
}

Status Sequence::write(uint32_t frame)
{
    const std::filesystem::path path = files_.of(frame);
    if (const Status status =
            capture(path, *renderer_, *opened_.device, *opened_.scene, opened_.settings, options_.layers);
        !status)
        return status.error().about(path.string());
    fmt::print(stderr, "{} ({} of {})\n", path.string(), ++written_, frame_count_);
    return Success{};
}

/// @param frames of one part, ascending
Status Sequence::renderPart(std::span<const uint32_t> frames)
{
    if (const Status status = begin(); !status)
        return status;
    const int64_t part = frames.front() / parts_.frames * parts_.frames;
    const int64_t warm_up = options_.mode == Mode::kGi ? parts_.warm_up : 0; // other modes remember nothing
    for (int64_t frame = part - warm_up; frame <= frames.back(); ++frame)
    {
        if (const Status status = renderSamples(frame, 1); !status)
            return status;
        if (frame != frames.front())
            continue;
        if (const Status status = write(frames.front()); !status)
            return status;
        if (frames = frames.subspan(1); frames.empty())
            break;
    }
    return Success{};
}

/// A frame of many samples is a standing picture: what another one left would only be in the way.
Status Sequence::renderStanding(uint32_t frame)
{
    if (const Status status = begin(); !status)
        return status;
    if (const Status status = renderSamples(frame, options_.sample_count); !status)
        return status;
    return write(frame);
}

Status Sequence::render(std::span<const uint32_t> frames)
{
    while (!frames.empty())
    {
        const bool standing = options_.sample_count > 0;
        const auto same_part = [&](uint32_t frame) { return frame / parts_.frames == frames.front() / parts_.frames; };
        const size_t count = standing ? 1 : size_t(std::ranges::find_if_not(frames, same_part) - frames.begin());
        const Status status = standing ? renderStanding(frames.front()) : renderPart(frames.first(count));
        if (!status)
            return status;
        frames = frames.subspan(count);
    }
    return Success{};
}

Status Sequence::writeResults()
{
    if (!renderer_)
        return Success{};
    PlayerOptions rest = options_;
    rest.output.clear(); // the frames are there
    return ::writeResults(rest, opened_, *renderer_, opened_.settings, statistics_);
}

Result<std::vector<uint32_t>> framesToRender(const PlayerOptions& options, const FrameFiles& files)
{
    if (!options.force)
        return files.missing(*options.sequence, options.width, options.height);
    std::vector<uint32_t> all(options.sequence->count());
    std::iota(all.begin(), all.end(), options.sequence->first);
    return all;
}

Status leaveAlone(const PlayerOptions& options, const Statistics& statistics)
{
    fmt::print(stderr, "all {} frames are there; --force renders them again\n", options.sequence->count());
    if (options.stats.empty())
        return Success{};
    const Status status = statistics.writeJson(options.stats);
    return status ? status : status.error().about(options.stats.string());
}
} // namespace

Status renderFrames(const PlayerOptions& options, const OpenedScene& opened, const FrameFiles& files,
                    std::span<const uint32_t> frames, Statistics& statistics, const SequenceParts& parts)
{
    Sequence sequence(options, opened, files, frames.size(), parts, statistics);
    const Status rendered = sequence.render(frames);
    const Status written = sequence.writeResults();
    return rendered ? written : rendered;
}

Status playSequence(const PlayerOptions& options)
{
    const auto files = FrameFiles::parse(options.output);
    if (!files)
        return files.error();
    const auto frames = framesToRender(options, *files);
    if (!frames)
        return frames.error();
    if (options.list_missing)
    {
        for (const uint32_t frame : *frames)
            fmt::print("{}\n", frame);
        return Success{};
    }
    Statistics statistics;
    if (frames->empty())
        return leaveAlone(options, statistics);
    noteInterruptions();
    const auto opened = openScene(options, {}, statistics);
    if (!opened)
        return opened.error();
    if (!opened->path && !opened->animation)
        return Error{ExitCode::kUsage,
                     "nothing in the package moves, so a range of --frames needs a camera path: --path "
                     "FILE, or a count of frames"};
    return renderFrames(options, *opened, *files, *frames, statistics);
}
