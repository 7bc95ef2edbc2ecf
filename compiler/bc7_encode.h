// Encodes blocks as BC7 (Khronos Data Format Specification 1.3, chapter 20): mode 6 for what lies along one line of colours, mode 1 for two
// regions of colour, mode 5 where one channel is uncorrelated with the others.
#pragma once
#include "compiler/lanes.h"

#include <cstddef>
#include <span>

/// @param channels red, green, blue, alpha, each 0 to 255 @param uses_alpha else it may come out as anything
void encodeBc7(const std::array<Lanes, 4>& channels, bool uses_alpha, std::span<std::byte, 16> block);
