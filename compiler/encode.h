// Vertex encodings, as gpu_scene.h defines them.
#pragma once
#include "compiler/linear.h"

#include <cstdint>

/// Octahedral, two 16-bit snorm numbers. @param n unit
uint32_t encodeNormal(gpu::vec3 n);

/// Octahedral with the bitangent's sign in bit 16. Never 0, which means "no tangent".
uint32_t encodeTangent(gpu::vec3 tangent, bool negative_bitangent);

/// Four halfs.
gpu::uvec2 encodeColor(float r, float g, float b, float a);

gpu::vec3 decodeNormal(uint32_t encoded);
gpu::vec3 decodeTangent(uint32_t encoded);
float decodeHalf(uint16_t half);
