// What `lumicut-bench motion` prints.
#pragma once
#include "tools/bench/ghost.h"
#include "tools/bench/sequence_metrics.h"

#include <optional>

struct MotionResult
{
    SequenceMetrics metrics;
    Mean plain; // share of a frame's pixels that SequenceFrame::plain has
    Ghost ghost{};
    std::optional<double> reprojected; // share of pixels with a history; none: the renderer keeps none
    StageSamples stages;               // of the frames that are judged
};

void printJson(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
void print(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result);
