// Convergence of a static view to its reference.
#pragma once
#include "runtime/settings.h"
#include "tools/bench/opened.h"

struct ConvergeBenchOptions : BenchOptions // width and height: the reference's
{
    std::filesystem::path reference; // .exr
    std::string mode = "gi";         // gi, reference
    std::filesystem::path output;    // .exr: the last run's last picture; empty: none
    uint32_t frames = 1;             // measured after 1, 2, 4, ... and all of them
    uint32_t seeds = 1;              // runs, over which errors and times are averaged
    uint32_t travel = 0;             // frames of a moving camera that come before each run's first and do not count
    bool stages = false;             // print the stages' times too
    Settings settings;
};

/// Prints seconds and errors after 1, 2, 4, ... frames. The clock runs while frames are recorded and rendered, after a
/// frame that makes all kernels ready.
Status benchConverge(const ConvergeBenchOptions& options);
