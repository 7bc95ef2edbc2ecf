// Renders without a window: frames in, a picture and statistics out.
#pragma once
#include "runtime/opened_scene.h"

/// Opens the package and the device, renders, writes --output and --stats.
/// Prints a line for people on stderr; stdout stays for results.
Status playHeadless(const PlayerOptions& options);

/// What a picture shows.
struct Moment
{
    double seconds = 0;           // of the animation
    std::optional<Camera> camera; // none: the scene's selected one
};

/// Renders `sample_count` samples a pixel more. @return false where a signal that noteInterruptions() knows of came first
bool renderSamples(Recorder& rec, Renderer& renderer, const OpenedScene& opened, const Moment& moment, uint32_t seed,
                   uint32_t sample_count, Statistics& statistics);
