#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/rays/rays.h"

// Sets a queue's length from the CPU. One thread.

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Params { QueueParams params; };

layout(set = 1, binding = 0, scalar) writeonly buffer Queue { QueueSize queue; };

void main()
{
    queue = queueSize(params.count);
}
