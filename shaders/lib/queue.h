// A count made on the GPU, and the dispatches that cover it. Shared by C++ and GLSL.
#ifndef LIB_QUEUE_H
#define LIB_QUEUE_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kQueueLeastGroup = 64u;
GPU_CONST uint kQueueRows = 3u; // group sizes that have a dispatch: 64, 128, 256

struct QueueSize
{
    uint count;
    uvec3 groups[kQueueRows]; // VkDispatchIndirectCommand of kernels with queueGroupSize(row) threads a group
};
GPU_SIZE(QueueSize, 40);

/// Threads of the groups that groups[row] is for. Recorder::runIndirect picks the row by the kernel's own size.
GPU_FUNCTION uint queueGroupSize(uint row)
{
    return kQueueLeastGroup << row;
}

/// The one place that turns a count into groups.
GPU_FUNCTION QueueSize queueSize(uint count)
{
    QueueSize size;
    size.count = count;
    for (uint row = 0u; row < kQueueRows; ++row)
    {
        size.groups[row].x = (count + queueGroupSize(row) - 1u) / queueGroupSize(row);
        size.groups[row].y = 1u;
        size.groups[row].z = 1u;
    }
    return size;
}

GPU_NAMESPACE_END
#endif
