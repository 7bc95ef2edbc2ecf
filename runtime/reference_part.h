// A part of a reference: some of a picture's samples, to be summed up with those of other runs, on other machines.
#pragma once
#include "runtime/opened_scene.h"

/// Renders options.samples of every pixel in mode reference and writes their sums. A file of the same samples that is there and
/// whole is left alone, but for options.force. On one device the sum of all parts does not depend on how they were cut.
/// @return kInvalid where another picture is there; ExitCode(128 + N) where signal N ended it, nothing is written then
Status playReferencePart(const PlayerOptions& options);
