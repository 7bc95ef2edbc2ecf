// Encodes one channel of a block as BC4 (Khronos Data Format Specification 1.3, chapter 19); BC5 is two of them.
#pragma once
#include "compiler/lanes.h"

#include <cstddef>
#include <span>

/// @param values 0 to 255; their fractions count, for what lies between the endpoints is finer than 1
void encodeBc4(const Lanes& values, std::span<std::byte, 8> block);
