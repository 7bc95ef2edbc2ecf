// Where the levels of the quadtree lie in its buffer: level 1 first, the root last. Functions only.
#ifndef SAMPLES_QUADTREE_GLSL
#define SAMPLES_QUADTREE_GLSL
#include "shaders/samples/samples.h"

uint levelCount(uint level, uint levels) { return 1u << (2u * (levels - level)); }

/// Nodes of levels 1 to level - 1: (4^levels - 4^(levels - level + 1)) / 3.
uint levelOffset(uint level, uint levels) { return (levelCount(0u, levels) - levelCount(level - 1u, levels)) / 3u; }

uint spreadBits(uint x) // sixteen bits, a zero before each
{
    x = (x | (x << 8)) & 0x00ff00ffu;
    x = (x | (x << 4)) & 0x0f0f0f0fu;
    x = (x | (x << 2)) & 0x33333333u;
    return (x | (x << 1)) & 0x55555555u;
}

/// Index of the point at column p.x, row p.y.
uint zOrder(uvec2 p) { return spreadBits(p.x) | spreadBits(p.y) << 1; }

#endif
