// The time of a frame by stage, with moving camera and light.
#pragma once
#include "runtime/settings.h"
#include "tools/bench/opened.h"

struct FrameBenchOptions : BenchOptions
{
    std::string mode = "gi";     // gi, direct, reference
    uint32_t frames = 120;       // timed
    uint32_t warm_up = 8;        // before them
    std::string moving = "both"; // camera, lights, both, nothing
    std::string animation;       // that plays, 60 frames a second; empty: none
    bool kernels = false;        // print every command of a frame too
    Settings settings;
};

/// Prints p50 and p95 of each stage, CPU time, memory, and the rays of a frame against the measured ray throughput.
Status benchFrame(const FrameBenchOptions& options);
