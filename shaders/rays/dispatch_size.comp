#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/rays/rays.h"

// Turns a queue's count into the group counts of its indirect dispatches. One thread.

layout(local_size_x = 1) in;

layout(set = 1, binding = 0, scalar) buffer Queue { QueueSize queue; };

void main()
{
    queue = queueSize(queue.count);
}
