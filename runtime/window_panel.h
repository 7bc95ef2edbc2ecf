// The panel of the window: what is measured, and everything that can be changed.
#pragma once
#include "runtime/animation.h"
#include "runtime/renderer.h"

/// What the panel shows.
struct PanelFacts
{
    std::string_view device;
    uint32_t width, height; // pixels
    uint32_t sample_count;  // a pixel
    double frame_ms;        // from one frame to the next
    std::span<const StageTime> stages;
    std::span<const Camera> cameras;
    float speed;                        // metres a second
    std::span<const std::string> clips; // of the package
    double duration;                    // of what plays, seconds
    std::string_view notice;            // "" or the last thing that happened, such as a screenshot
};

/// What the person did to it.
struct PanelActions
{
    std::optional<size_t> camera; // index to jump to
    bool restart = false;         // the samples so far show something else
};

/// Draws the panel and changes `settings`, `mode` and `playback` by the user's input. Inside an ImGui frame only.
PanelActions drawPanel(const PanelFacts& facts, Settings& settings, Mode& mode, Playback& playback);
