// Climbing a tree from its leaves with one thread a leaf: at every node the second to arrive continues, so no thread waits.
// Functions only.
#ifndef LIB_CLIMB_GLSL
#define LIB_CLIMB_GLSL

/// Makes a thread's writes visible to threads that arrive later. Off on CPU devices, whose atomics order memory anyway:
/// Mesa 22.3's software driver loses threads at a memory barrier in a loop that others have left.
layout(constant_id = 2) const bool kFences = true;

void fence()
{
    if (kFences)
        memoryBarrierBuffer();
}

#endif
