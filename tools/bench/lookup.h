// Lookups in the illumination cut against density estimation in the whole photon map and against path tracing: time and
// error.
#pragma once
#include "runtime/settings.h"
#include "tools/bench/opened.h"

struct LookupBenchOptions : BenchOptions
{
    uint32_t repeats = 8;       // frames of each mode
    uint32_t truth_rays = 4096; // of the path tracer, from each sample; 0: none
    Settings settings;
};

/// Prints, for each cut.mode, the cut's nodes, nanoseconds a lookup, and error and ratio of the samples' irradiance against
/// full kNN and against path tracing from the same samples. Samples are the same in all frames and modes, photons and gather
/// rays in all modes.
Status benchLookup(const LookupBenchOptions& options);
