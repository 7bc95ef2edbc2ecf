// What playing begins and ends with, in a window or without one: a package on a device, then results on the disk.
#pragma once
#include "runtime/player_options.h"
#include "runtime/statistics.h"

/// A package's scene on the device that was asked for. Its members may be borrowed for as long as it lives.
struct OpenedScene
{
    Instance instance;
    std::unique_ptr<Device> device;
    std::unique_ptr<SceneGpu> scene;
    std::vector<Camera> cameras; // the package's, at least one
    Camera camera;               // the one asked for
    Settings settings;           // of the preset and --set
};

/// Opens package, device and camera as `options` say.
/// @param window_extensions what the window library needs of Vulkan; empty: the device will never show a window
Result<OpenedScene> openScene(const PlayerOptions& options, std::span<const char* const> window_extensions,
                              Statistics& statistics);

/// Prints the summary on stderr, and writes --output and --stats where they are asked for.
Status writeResults(const PlayerOptions& options, const OpenedScene& opened, Renderer& renderer, const Settings& settings,
                    Statistics& statistics);
