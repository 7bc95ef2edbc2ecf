// Renders in a window, under the hands of a person.
#pragma once
#include "runtime/player_options.h"

/// Opens the package and a window and plays until it is closed, or --frames or --spp are reached; then writes --output
/// and --stats. @return kDevice where there is no display
Status playWindowed(const PlayerOptions& options);
