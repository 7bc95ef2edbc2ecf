// Where the levels of the quadtree lie in its buffer: level 1 first, the root last. Functions only.
#ifndef SAMPLES_QUADTREE_GLSL
#define SAMPLES_QUADTREE_GLSL
#include "shaders/samples/samples.h"

uint levelCount(uint level, uint levels) { return 1u << (2u * (levels - level)); }

/// Nodes of levels 1 to level - 1: (4^levels - 4^(levels - level + 1)) / 3.
uint levelOffset(uint level, uint levels) { return (levelCount(0u, levels) - levelCount(level - 1u, levels)) / 3u; }

#endif
