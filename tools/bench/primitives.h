// Throughput of the parallel primitives: how many items a second they sort, scan, compact and reduce.
#pragma once
#include "format/result.h"

#include <cstdint>
#include <string>
#include <vector>

struct PrimitiveBenchOptions
{
    std::vector<uint32_t> items{1u << 12, 1u << 16, 1u << 20, 1u << 22};
    uint32_t repeats = 20; // timed runs of each kind and size; the median counts
    std::string device;
    std::string workers = "auto"; // auto, groups or threads
    bool json = false;
};

/// Prints GItems/s of each primitive on random input at several sizes, measured by GPU timestamps around the primitive
/// alone, after a warm-up, the kinds interleaved.
Status benchPrimitives(const PrimitiveBenchOptions& options);
