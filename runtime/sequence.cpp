#include "runtime/sequence.h"

#include "image/write_image.h"
#include "runtime/frame_files.h"
#include "runtime/frame_seed.h"
#include "runtime/frame_writer.h"
#include "runtime/headless.h"
#include "runtime/interruption.h"
#include "runtime/nearest_origin.h"
#include "runtime/opened_scene.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>

namespace
{
/// Renders frames of one sequence.
class Sequence
{
public:
    /// @param frame_count that render() will be given
    Sequence(const PlayerOptions& options, const OpenedScene& opened, const PictureOrigin& origin,
             const FrameFiles& files, size_t frame_count, int64_t warm_up, Statistics& statistics)
        : options_(options), opened_(opened), files_(files), frame_count_(frame_count), warm_up_(warm_up),
          statistics_(statistics), rec_(*opened.device), writer_(originNotes(origin), frame_count)
    {
    }

    /// @param frames ascending
    Status render(std::span<const uint32_t> frames);
    /// Nothing where not even a renderer could be made.
    Status writeResults();

private:
    Moment momentOf(int64_t frame) const;
    Status begin(int64_t frame);
    Status renderAll(std::span<const uint32_t> frames);
    Status renderPart(std::span<const uint32_t> frames);
    Status renderStanding(uint32_t frame);
    Status renderSamples(int64_t frame, uint32_t sample_count);
    Status write(uint32_t frame);
    /// Milliseconds of the program so far, but for waiting for pipelines: that is part of its start.
    double workMs() const { return statistics_.elapsedMs() - opened_.device->pipelineMs(); }

    const PlayerOptions& options_;
    const OpenedScene& opened_;
    const FrameFiles& files_;
    size_t frame_count_; // that are to be written
    int64_t warm_up_;    // frames of mode gi before each part
    Statistics& statistics_;
    Recorder rec_;
    FrameWriter writer_;
    std::optional<Renderer> renderer_;
};

Moment Sequence::momentOf(int64_t frame) const
{
    const double seconds = double(frame) / options_.fps;
    return {.seconds = opened_.animationTime(options_.seconds.value_or(0) + seconds),
            .camera = opened_.path ? std::optional(opened_.path->at(seconds)) : std::nullopt};
}

/// A renderer that remembers nothing. How it divides lights into clusters, say, depends on where they are then: always where they
/// are in `frame`, whatever this process has shown before.
Status Sequence::begin(int64_t frame)
{
    rec_.begin(opened_.scene->descriptorSet());
    opened_.pose(rec_, momentOf(frame).seconds);
    rec_.submitAndWait();
    if (const Status status = makeRenderer(renderer_, opened_, options_.mode, options_.width, options_.height,
                                           opened_.settings, !options_.layers.empty());
        !status)
        return status;
    return Success{};
}

Status Sequence::renderSamples(int64_t frame, uint32_t sample_count)
{
    if (::renderSamples(rec_, *renderer_, opened_, momentOf(frame), frameSeed(options_.seed, frame), sample_count,
                        statistics_))
        return Success{};
    return Error{ExitCode(128 + interruption()),
                 fmt::format("ended by a signal ({}) with {} of {} frames written; the same command renders the others",
                             ::strsignal(interruption()), writer_.writtenCount(), frame_count_)};
}

Status Sequence::write(uint32_t frame)
{
    return writer_.write(
        Capture(files_.of(frame), *renderer_, *opened_.device, *opened_.scene, opened_.settings, options_.layers));
}

/// @param frames of one part, ascending
Status Sequence::renderPart(std::span<const uint32_t> frames)
{
    int64_t next = int64_t(frames.front() / options_.part * options_.part) - warm_up_;
    if (const Status status = begin(next); !status)
        return status;
    while (!frames.empty())
    {
        // Other modes remember nothing: every frame has a seed of its own, with which a renderer begins anew.
        const int64_t frame = options_.mode == Mode::kGi ? next++ : frames.front();
        const double start = workMs();
        if (const Status status = renderSamples(frame, 1); !status)
            return status;
        if (frame != frames.front())
        {
            statistics_.thrown_away_ms += workMs() - start;
            continue;
        }
        if (const Status status = write(frames.front()); !status)
            return status;
        statistics_.frames_ms += workMs() - start;
        frames = frames.subspan(1);
    }
    return Success{};
}

/// A frame of many samples is a standing picture: what another one left would only be in the way.
Status Sequence::renderStanding(uint32_t frame)
{
    if (const Status status = begin(frame); !status)
        return status;
    const double start = workMs();
    if (const Status status = renderSamples(frame, options_.sample_count); !status)
        return status;
    const Status status = write(frame);
    statistics_.frames_ms += workMs() - start;
    return status;
}

Status Sequence::render(std::span<const uint32_t> frames)
{
    const Status rendered = renderAll(frames);
    const double start = workMs();
    const Status written = writer_.finish(); // those before a signal, too
    statistics_.frames_ms += workMs() - start;
    statistics_.frames_written = uint32_t(writer_.writtenCount());
    return rendered ? written : rendered;
}

Status Sequence::renderAll(std::span<const uint32_t> frames)
{
    while (!frames.empty())
    {
        const bool standing = options_.sample_count > 0;
        const auto same_part = [&](uint32_t frame) { return frame / options_.part == frames.front() / options_.part; };
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
    fmt::print(stderr,
               "{} of {} frames written in {:.2f} s: {:.2f} s for them, {:.2f} s for frames that are not kept\n",
               writer_.writtenCount(), frame_count_, 1e-3 * statistics_.elapsedMs(), 1e-3 * statistics_.frames_ms,
               1e-3 * statistics_.thrown_away_ms);
    PlayerOptions rest = options_;
    rest.output.clear(); // the frames are there
    return ::writeResults(rest, opened_, *renderer_, opened_.settings, statistics_);
}

/// What is on the disk of a sequence, and what is to be done.
struct Request
{
    std::vector<uint32_t> whole;  // frames that are there and stay
    std::vector<uint32_t> frames; // to render
};

Result<Request> requestOf(const PlayerOptions& options, const FrameFiles& files)
{
    Request request;
    if (options.force)
    {
        request.frames.resize(options.sequence->count());
        std::iota(request.frames.begin(), request.frames.end(), options.sequence->first);
        return request;
    }
    auto there = files.look(*options.sequence, options.width, options.height);
    if (!there)
        return there.error();
    request.whole = std::move(there->whole);
    request.frames = std::move(there->missing);
    return request;
}

/// Frames that stay must be those that this run would render: all of one of `origins`.
/// @return kInvalid naming one that is not
Status checkOrigins(const FrameFiles& files, std::span<const uint32_t> frames, std::vector<PictureOrigin> origins)
{
    std::map<std::string, size_t> devices;
    for (const uint32_t frame : frames)
    {
        const std::filesystem::path path = files.of(frame);
        const auto origin = readOrigin(path);
        if (!origin)
            return origin.error().about(path.string());
        const std::string differing = nearestDifference(*origin, origins);
        std::erase_if(origins, [&](const PictureOrigin& wanted) { return !difference(*origin, wanted).empty(); });
        if (origins.empty())
            return Error{
                ExitCode::kInvalid,
                fmt::format("is there already and was rendered {}; a film of both would be mixed. Choose another "
                            "folder, or give --force to render all of them again",
                            differing),
                path.string()};
        ++devices[origin->device];
    }
    if (devices.size() > 1)
        for (const auto& [device, count] : devices)
            fmt::print(stderr, "warning: {} frames were rendered by {}: another device, other noise\n", count, device);
    return Success{};
}

/// Before anything is rendered: whether the frames' folder can be written to, and no folder has a frame's name.
Status checkTargets(const FrameFiles& files, std::span<const uint32_t> frames)
{
    for (const uint32_t frame : frames)
    {
        const std::filesystem::path path = files.of(frame);
        std::error_code ignored;
        if (frame != frames.front() && !std::filesystem::is_directory(path, ignored))
            continue;
        if (const Status status = canWriteFile(path); !status)
            return status.error().about(path.string());
    }
    return Success{};
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
                    std::span<const uint32_t> frames, Statistics& statistics, int64_t warm_up)
{
    const auto origin = originOf(opened, options);
    if (!origin)
        return origin.error();
    Sequence sequence(options, opened, *origin, files, frames.size(), warm_up, statistics);
    const Status rendered = sequence.render(frames);
    const Status written = sequence.writeResults();
    return rendered ? written : rendered;
}

Status playSequence(const PlayerOptions& options)
{
    const auto files = FrameFiles::parse(options.output);
    if (!files)
        return files.error();
    noteInterruptions(); // shares may be slow
    const auto request = requestOf(options, *files);
    if (!request)
        return request.error();
    if (!request->whole.empty())
    {
        const auto origins = possibleOrigins(options);
        if (!origins)
            return origins.error();
        if (const Status status = checkOrigins(*files, request->whole, *origins); !status)
            return status;
    }
    if (options.list_missing)
    {
        for (const uint32_t frame : request->frames)
            fmt::print("{}\n", frame);
        return Success{};
    }
    Statistics statistics;
    if (request->frames.empty())
        return leaveAlone(options, statistics);
    if (const Status status = checkTargets(*files, request->frames); !status)
        return status;
    const auto opened = openScene(options, {}, statistics);
    if (!opened)
        return opened.error();
    if (!opened->path && !opened->animation)
        return Error{ExitCode::kUsage,
                     "nothing in the package moves, so a range of --frames needs a camera path: --path "
                     "FILE, or a count of frames"};
    const auto origin = originOf(*opened, options);
    if (!origin)
        return origin.error();
    // By now the device has chosen the preset.
    if (const Status status =
            checkOrigins(*files, std::span(request->whole).first(request->whole.empty() ? 0 : 1), {*origin});
        !status)
        return status;
    return renderFrames(options, *opened, *files, request->frames, statistics);
}
