// The options of lumicut-play's command line.
#pragma once
#include "runtime/renderer.h"
#include "runtime/settings.h"

#include <filesystem>
#include <string>
#include <vector>

struct PlayerOptions
{
    std::filesystem::path package;
    bool headless = false;
    uint32_t width = 1280; // pixels
    uint32_t height = 720;
    uint32_t frame_count = 0; // 0: --spp decides; without either, 1 headless and no end in a window
    uint32_t sample_count = 0; // samples a pixel, 0: one a frame
    std::filesystem::path output; // .exr or .png; empty: none
    Mode mode = Mode::kGi;
    std::string camera; // name or index; empty: the first
    uint32_t seed = 0;
    std::string device;
    std::filesystem::path stats; // .json; empty: none
    std::filesystem::path against; // .exr that the view "error" compares with; empty: none
    bool validation = false;
    std::string preset; // empty: preview on a CPU device, else default
    std::vector<std::string> assignments; // of settings, "name=value", valid
};
