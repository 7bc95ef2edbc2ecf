// Pictures of a moving camera, frame by frame, each into a file of its own.
#pragma once
#include "runtime/frame_files.h"
#include "runtime/opened_scene.h"

/// Renders options.sequence along options.path: frame i shows the path at i / options.fps seconds. Frames that are
/// there and whole are left as they are (but with options.force); with options.list_missing the numbers of the others
/// are printed on stdout and nothing is rendered. Every frame is written under a temporary name and renamed. On one
/// device a frame's bytes do not depend on which others are rendered, or when.
/// @return ExitCode(128 + N) where signal N ended it; what is written by then is whole and stays
Status playSequence(const PlayerOptions& options);

/// Frames before each part of a sequence whose pictures are thrown away. Parts do not depend on each other: they begin at multiples
/// of options.part, each with a new renderer.
///
/// A renderer remembers earlier frames, and a frame must come out the same whether those were rendered in this run or not.
/// kWarmUp / part is what that costs, a quarter of the time of the frames themselves with parts of 64, and a run that begins within
/// a part renders the frames of the part before that, too. With history.frames=32 a pixel is the mean of up to 33 frames, or as even
/// as one of 65 since the weights fade; at a part's start it is that of 17: noisier by sqrt(65 / 17) = 1.95, not darker, and less
/// with every frame. Without warming up it would be by 8.
inline constexpr int64_t kWarmUp = 16;

/// Renders `frames`, ascending, of options.sequence into `files`, as playSequence() says of them.
Status renderFrames(const PlayerOptions& options, const OpenedScene& opened, const FrameFiles& files,
                    std::span<const uint32_t> frames, Statistics& statistics, int64_t warm_up = kWarmUp);
