// Ray producers of lumicut-bench. Shared by tools/bench/*.cpp and shaders/bench/*.comp.
#ifndef SHADERS_BENCH_H
#define SHADERS_BENCH_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

struct DiffuseParams
{
    uint seed;
};
GPU_SIZE(DiffuseParams, 4);

GPU_NAMESPACE_END
#endif
