#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/primitives/primitives.h"

// The sums of vec4s by segment.

#define VALUE vec4
#include "shaders/primitives/reduce.glsl"
