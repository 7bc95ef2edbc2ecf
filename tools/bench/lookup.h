// The illumination cut against the photon map that it stands for: what a gather ray's lookup costs and how far it is off.
#pragma once
#include "runtime/settings.h"
#include "tools/bench/opened.h"

struct LookupBenchOptions : BenchOptions
{
    uint32_t repeats = 8; // frames of each mode, the first of which is not timed
    Settings settings;
};

/// Prints, for each cut.mode, nanoseconds a lookup and the error of the samples' irradiance against full kNN. Samples and
/// gather rays are the same in all of them.
Status benchLookup(const LookupBenchOptions& options);
