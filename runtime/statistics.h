// What a run of the player measured.
#pragma once
#include "format/result.h"
#include "runtime/gpu/recorder.h"

#include <chrono>
#include <filesystem>

struct Statistics
{
    std::string device;
    double open_ms = 0;    // package verified, since the start
    double package_ms = 0; // reading and verifying it, side by side with device_ms
    double device_ms = 0;  // finding and opening the device
    double upload_ms = 0;  // bringing the scene to it
    double ready_ms = 0;   // all that done, since the start; what follows is the stages' memory, tables and pipelines
    double first_submit_ms = 0; // first frame handed to the device, since the start
    double pipeline_ms = 0;     // of that, waiting for pipelines, which threads build
    uint64_t device_bytes = 0;
    uint32_t sample_count = 0; // a pixel
    uint32_t non_finite_samples = 0;
    uint32_t photon_paths = 0;                  // of the last frame's map, whole in it
    uint32_t photon_paths_asked = 0;            // more than those where the store was full
    uint32_t photons = 0;                       // that they left
    uint32_t frames_written = 0;                // of a sequence, or a part of --samples
    double frames_ms = 0;                       // for these, from the first sample to the file
    double thrown_away_ms = 0;                  // for frames of a sequence that are not kept
    std::vector<std::vector<StageTime>> frames; // of the first kMeasuredFrames submissions

    double elapsedMs() const;
    /// Of the first frame, recorded and about to be submitted.
    void noteFirstSubmit(const Device& opened)
    {
        first_submit_ms = elapsedMs();
        pipeline_ms = opened.pipelineMs();
    }
    /// The result of `work()`, and in `ms` how long it took.
    template <typename Work>
    auto timed(double& ms, const Work& work) const
    {
        const double start = elapsedMs();
        auto result = work();
        ms = elapsedMs() - start;
        return result;
    }
    void addFrame(std::vector<StageTime> times)
    {
        if (frames.size() < kMeasuredFrames)
            frames.push_back(std::move(times));
    }
    /// p50 and p95 of each stage over all submissions but the first.
    std::string summary() const;
    /// Schema "lumicut-play-stats/1".
    Status writeJson(const std::filesystem::path& path) const;

private:
    static constexpr size_t kMeasuredFrames = 1000; // enough for percentiles; a window may stay open for days
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};
