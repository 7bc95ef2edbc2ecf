// Renders without a window: frames in, a picture and statistics out.
#pragma once
#include "runtime/player_options.h"

/// Opens the package and the device, renders, writes --output and --stats.
/// Prints a line for people on stderr; stdout stays for results.
Status playHeadless(const PlayerOptions& options);
