// Sorting, scanning, compacting: what the stages build their lists with.
// Shared by runtime/stages/primitives.cpp and shaders/primitives/*.comp.
#ifndef SHADERS_PRIMITIVES_H
#define SHADERS_PRIMITIVES_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kPrimitivesGroupSize = 256u;
GPU_CONST uint kMaxDigitBits = 8u;
GPU_CONST uint kMaxDigits = 256u; // of kMaxDigitBits bits

// Workgroups that share a scan; no more than kPrimitivesGroupSize, so that a thread each can add up their sums.
GPU_CONST uint kMaxScanGroups = 256u;
GPU_CONST uint kScanItems = 8u; // per thread of a tile
GPU_CONST uint kScanTile = 2048u;
GPU_CONST uint kLongScanTile = 16384u; // least share of a workgroup that scans its share as one tile

GPU_CONST uint kSortItems = 8u; // per thread of a tile
GPU_CONST uint kSortTile = 2048u;
GPU_CONST uint kMaxSortGroups = 1024u;
GPU_CONST uint kSmallSortItems = 16u;
GPU_CONST uint kSmallSort = 4096u; // pairs that one workgroup sorts in one dispatch

// On a device that runs threads one after the other, every thread is a worker of its own.
GPU_CONST uint kLanes = 8u; // threads of a workgroup; counters of all fill 8 KiB of shared memory
GPU_CONST uint kMaxLaneGroups = 32u;
GPU_CONST uint kLaneLeast = 512u; // pairs for which a further worker pays

GPU_CONST uint kReduceItems = 32u; // values that a thread adds up at each level of a segmented reduction

struct SortParams
{
    uint max_count;
    uint first_bit;  // of the digit
    uint digit_bits; // 1 to kMaxDigitBits
    uint worker_count;
};
GPU_SIZE(SortParams, 16);

struct SmallSortParams
{
    uint max_count;
    uint key_bits;
};
GPU_SIZE(SmallSortParams, 8);

struct ScanParams
{
    uint max_count;
    uint group_count;
    uint least_share; // of a workgroup, a multiple of kPrimitivesGroupSize
};
GPU_SIZE(ScanParams, 12);

struct ReduceParams
{
    uint max_count;
    uint segment_count;
    uint level;
    uint is_last_level; // 0 or 1
};
GPU_SIZE(ReduceParams, 16);

GPU_NAMESPACE_END
#endif
