// What the player's options make of a package.
#pragma once
#include "image/picture_origin.h"
#include "runtime/player_options.h"

/// What `options` with these settings make of the package. @return kIo, kInvalid about the package or the path
Result<PictureOrigin> frameOrigin(const PlayerOptions& options, const Settings& settings);

/// Those that frames of `options` may have: where no preset is given, it is the device that chooses between two.
Result<std::vector<PictureOrigin>> possibleOrigins(const PlayerOptions& options);
