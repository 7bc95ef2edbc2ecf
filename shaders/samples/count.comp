#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/rays/rays.h"
#include "shaders/samples/samples.h"

// How many samples there are, kept and new. One thread.

layout(local_size_x = 1) in;

layout(set = 1, binding = 0, scalar) readonly buffer KeptSize { QueueSize kept_size; };
layout(set = 1, binding = 1, scalar) readonly buffer NewSize { QueueSize new_size; };
layout(set = 1, binding = 2, scalar) writeonly buffer Size { QueueSize size; };

void main()
{
    uint count = kept_size.count + new_size.count;
    size = queueSize(count);
}
