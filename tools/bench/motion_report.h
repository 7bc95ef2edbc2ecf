// What `lumicut-bench motion` prints.
#pragma once
#include "tools/bench/ghost.h"
#include "tools/bench/sequence_metrics.h"

#include <optional>

struct MotionResult
{
    SequenceMetrics metrics;
    Mean plain; // fraction of a frame's pixels in SequenceFrame::plain
    Ghost ghost{};
    std::optional<double> reprojected; // fraction of pixels with a history; nothing if the renderer keeps none
    StageSamples stages;               // of the measured frames
};

void printJson(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
void print(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
