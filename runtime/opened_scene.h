// What playing begins and ends with, in a window or without one: a package on a device, then results on the disk.
#pragma once
#include "runtime/animation.h"
#include "runtime/camera_path.h"
#include "runtime/frame_origin.h"
#include "runtime/player_options.h"
#include "runtime/statistics.h"

/// Why the view error shows nothing.
inline constexpr std::string_view kNothingToCompareWith = "the view error needs a rendering to compare with: --against "
                                                          "FILE.exr, as --mode reference --output FILE.exr writes it";

/// A rendering from elsewhere.
struct Rendering
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<gpu::vec3> pixels; // linear radiance, rows from the top; empty: there is none
};

/// A package's scene on the selected device. Its members may be borrowed for as long as it lives.
struct OpenedScene
{
    Instance instance;
    std::unique_ptr<Device> device;
    std::string device_text; // its name and driver
    std::unique_ptr<SceneGpu> scene;
    std::unique_ptr<package::Package> package; // where the animation needs it, else none
    std::unique_ptr<Animation> animation;      // none: the package has no motion
    AnimationChoice plays;                     // of --animation
    std::vector<Camera> cameras;               // the package's, at least one
    size_t camera_index = 0;                   // of the selected one
    std::optional<CameraPath> path;            // of --path
    Settings settings;                         // of the preset and --set
    Rendering against;                         // of --against

    const Camera& camera() const { return cameras[camera_index]; } // the selected one, at rest
    /// What the scene and the selected camera are from the next kernel of `rec` on. @param seconds of the animation
    Camera pose(Recorder& rec, double seconds) const;
    /// Where the animation is after `seconds` of playing over and over.
    double animationTime(double seconds) const;
};

/// Opens package, device, camera and path as `options` say.
/// @param window_extensions what the window library needs of Vulkan; empty: the device will never show a window
Result<OpenedScene> openScene(const PlayerOptions& options, std::span<const char* const> window_extensions,
                              Statistics& statistics);

/// What its pictures are made from, and how.
Result<PictureOrigin> originOf(const OpenedScene& opened, const PlayerOptions& options);

/// A renderer for pictures of that size, with what its view error compares with.
/// @return kDevice where they are too large for the device, leaving `renderer` empty
/// @param layers whether it keeps the layers of its pictures
Status makeRenderer(std::optional<Renderer>& renderer, const OpenedScene& opened, Mode mode, uint32_t width,
                    uint32_t height, const Settings& settings, bool layers = false);

/// Prints the summary on stderr, and writes --output and --stats if given.
Status writeResults(const PlayerOptions& options, const OpenedScene& opened, Renderer& renderer,
                    const Settings& settings, Statistics& statistics);
