// The options of lumicut-play's command line.
#pragma once
#include "runtime/frame_files.h"
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
    uint32_t frame_count = 0;            // 0: --spp decides; without either, 1 headless and no end in a window
    uint32_t sample_count = 0;           // samples a pixel, 0: one a frame
    std::optional<NumberRange> samples;  // mode reference: these alone of a picture, to be summed up with others
    std::filesystem::path path;          // of the camera, .json; empty: it stands still, or flies by hand
    std::optional<NumberRange> sequence; // headless: these frames along `path`, each into a file
    double fps = 30;                     // frames a second of the path's time
    uint32_t part = 64;                  // frames of a sequence of mode gi that go on from each other
    bool force = false;                  // renders frames again that are there
    bool list_missing = false;           // prints the numbers of frames that are not there, and renders nothing
    std::filesystem::path output;        // .exr or .png, of a sequence with a place for the number; empty: none
    std::vector<std::string> layers;     // of kLayerNames, that an .exr holds; empty: the picture alone
    Mode mode = Mode::kGi;
    std::string camera;    // name or index; empty: the first
    std::string animation; // name, index, all or none; empty: the first where a time is shown
    std::optional<double>
        seconds; // of the animation, at the first frame; none: 0, and the pose at rest for a single picture
    uint32_t seed = 0;
    std::string device;
    std::filesystem::path stats;   // .json; empty: none
    std::filesystem::path against; // .exr that the view "error" compares with; empty: none
    bool validation = false;
    std::string preset;                   // empty: preview on a CPU device, else default
    std::vector<std::string> assignments; // of settings, "name=value", valid
};
