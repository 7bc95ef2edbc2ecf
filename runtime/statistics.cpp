#include "runtime/statistics.h"

#include "image/write_image.h"

#include <algorithm>
#include <map>

namespace
{
struct StageSummary
{
    std::string name;
    double p50 = 0, p95 = 0; // ms
};

std::vector<StageSummary> summarise(const std::vector<std::vector<StageTime>>& frames)
{
    std::vector<StageSummary> summaries;
    if (frames.empty())
        return summaries;
    const size_t first = frames.size() > 1 ? 1 : 0; // the first submission also warms up
    for (const StageTime& stage : frames[0])
    {
        std::vector<double> times;
        for (size_t f = first; f < frames.size(); ++f)
            for (const StageTime& time : frames[f])
                if (time.name == stage.name)
                    times.push_back(time.ms);
        std::ranges::sort(times);
        if (!times.empty())
            summaries.push_back(
                {stage.name, times[times.size() / 2], times[std::min(times.size() - 1, times.size() * 95 / 100)]});
    }
    return summaries;
}

std::string jsonString(const std::string& text)
{
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' || c == '\\' ? fmt::format("\\{}", c)
                  : uint8_t(c) < 0x20   ? fmt::format("\\u{:04x}", c)
                                        : std::string(1, c);
    return quoted + "\"";
}
} // namespace

double Statistics::elapsedMs() const
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
}

std::string Statistics::summary() const
{
    std::string text = fmt::format(
        "{}: {} samples a pixel, first frame submitted after {:.0f} ms (device {:.0f}, beside it package {:.0f}, "
        "upload {:.0f}, stages {:.0f}, of these waiting for pipelines {:.0f})",
        device, sample_count, first_submit_ms, device_ms, package_ms, upload_ms, first_submit_ms - ready_ms,
        pipeline_ms);
    for (const StageSummary& stage : summarise(frames))
        text += fmt::format("\n  {:<12} p50 {:9.3f} ms  p95 {:9.3f} ms", stage.name, stage.p50, stage.p95);
    if (photon_paths < photon_paths_asked)
        text +=
            fmt::format("\n  the photon map is full: its {} photons are of {} paths, not of {}; see photons.capacity",
                        photons, photon_paths, photon_paths_asked);
    if (non_finite_samples > 0)
        text += fmt::format("\n  {} samples were not finite and are left out", non_finite_samples);
    return text;
}

Status Statistics::writeJson(const std::filesystem::path& path) const
{
    std::string text = fmt::format(
        "{{\n  \"schema\": \"lumicut-play-stats/1\",\n  \"device\": {},\n  \"open_ms\": {:.3f},\n"
        "  \"package_ms\": {:.3f},\n  \"device_ms\": {:.3f},\n  \"upload_ms\": {:.3f},\n  \"ready_ms\": {:.3f},\n"
        "  \"first_submit_ms\": {:.3f},\n  \"pipeline_ms\": {:.3f},\n  \"device_bytes\": {},\n"
        "  \"samples_per_pixel\": {},\n  \"non_finite_samples\": {},\n  \"photons\": {},\n"
        "  \"photon_paths\": {},\n  \"photon_paths_asked\": {},\n  \"submissions\": {},\n"
        "  \"frames_written\": {},\n  \"frames_ms\": {:.3f},\n  \"thrown_away_ms\": {:.3f},\n  \"elapsed_ms\": "
        "{:.3f},\n  \"stages\": [",
        jsonString(device), open_ms, package_ms, device_ms, upload_ms, ready_ms, first_submit_ms, pipeline_ms,
        device_bytes, sample_count, non_finite_samples, photons, photon_paths, photon_paths_asked, frames.size(),
        frames_written, frames_ms, thrown_away_ms, elapsedMs());
    const auto stages = summarise(frames);
    for (size_t i = 0; i < stages.size(); ++i)
        text += fmt::format("{}\n    {{\"name\": {}, \"p50_ms\": {:.4f}, \"p95_ms\": {:.4f}}}", i ? "," : "",
                            jsonString(stages[i].name), stages[i].p50, stages[i].p95);
    text += "\n  ]\n}\n";
    return writeFile(path, std::span(reinterpret_cast<const uint8_t*>(text.data()), text.size()));
}
