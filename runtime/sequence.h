// Pictures of a moving camera, frame by frame, each into a file of its own.
#pragma once
#include "runtime/player_options.h"

/// Renders options.sequence along options.path: frame i shows the path at i / options.fps seconds. Frames that are
/// there and whole are left as they are (but with options.force); with options.list_missing the numbers of the others
/// are printed on stdout and nothing is rendered. Every frame is written under a temporary name and renamed. On one
/// device a frame's bytes do not depend on which others are rendered, or when.
/// @return ExitCode(128 + N) where signal N ended it; what is written by then is whole and stays
Status playSequence(const PlayerOptions& options);
