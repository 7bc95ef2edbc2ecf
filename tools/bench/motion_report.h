// What `lumicut-bench motion` prints.
#pragma once
#include "tools/bench/ghost.h"
#include "tools/bench/sequence_metrics.h"

#include <array>
#include <optional>

/// All light of the frames and of their references, before a display limits it, per channel.
struct LightSums
{
    std::array<double, 3> pictures{}, references{};

    void add(const ImageF& picture, const ImageF& reference);
    /// 1: nothing lags or is lost. NaN where the references are black.
    std::array<double, 3> ratio() const;
};

struct MotionResult
{
    SequenceMetrics metrics;
    LightSums light;
    Mean plain; // fraction of a frame's pixels in SequenceFrame::plain
    Ghost ghost{};
    std::optional<double> reprojected; // fraction of pixels with a history; nothing if the renderer keeps none
    StageSamples stages;               // of the measured frames
};

void printJson(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
void print(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
