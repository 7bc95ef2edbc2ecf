#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The sums of floats by segment.

#define VALUE float
#include "shaders/primitives/reduce.glsl"
