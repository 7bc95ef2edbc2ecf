// The picture while the camera moves: how far it is from the truth, how much it flickers, what it remembers too long.
#pragma once
#include "runtime/renderer.h"
#include "tools/bench/changing_lights.h"
#include "tools/bench/motion_path.h"
#include "tools/bench/opened.h"

struct MotionBenchOptions : BenchOptions
{
    std::string path = "sway";     // sway, orbit, or a file that CameraPath::load() reads
    std::string lights = "steady"; // one of kLightChangeNames; "off" in the middle of the sequence
    std::string animation;         // that plays on the path's time; empty: none
    std::string mode = "gi";       // gi, direct, or reference: path tracing with what mode gi remembers and filters
    std::string preset;            // that the settings come from, for the report
    uint32_t frames = 60;          // judged
    uint32_t warm_up = 8;          // before them, on the same path
    double frames_per_second = 30;
    uint32_t sample_count = 256; // a pixel, of the references
    bool ghost = true;           // measure ghosts too
    uint32_t seed = 0;           // another one, other noise
    std::filesystem::path cache; // of references; empty: the user's cache folder, else the system's for temporary files
    std::filesystem::path dump;  // for pictures of each frame; empty: none
    Settings settings;
};

/// Prints moving FLIP, flicker, ghosts and the stages' times, as text or schema "lumicut-bench-motion/1".
Status benchMotion(const MotionBenchOptions& options);

/// The seed of a frame. Frames before the first are negative.
uint32_t frameSeed(const MotionBenchOptions& options, int32_t frame);

Mode modeOf(const MotionBenchOptions& options);
