// Opening a package for a measurement, and statistics of measurements.
#pragma once
#include "image/image.h"
#include "runtime/camera.h"
#include "runtime/gpu/recorder.h"
#include "runtime/renderer.h"

#include <filesystem>

struct BenchOptions
{
    std::filesystem::path package;
    uint32_t width = 0, height = 0; // pixels
    std::string camera;             // name or index; empty: the first
    std::string device;             // index, part of a name, or cpu; empty: the best suitable one
    bool json = false;
};

/// A package on a device. Its members may be borrowed for as long as it lives.
struct OpenedPackage
{
    package::Package package;
    std::unique_ptr<Device> device;
    std::unique_ptr<SceneGpu> scene;
    Camera camera;
};

/// @param kernel_statistics whether the device is to tell of the kernels' machine code
Result<OpenedPackage> openPackage(const BenchOptions& options, bool kernel_statistics = false);

/// What the renderer shows, linear, rows from the top; NaN and infinities are black. Waits for the device.
ImageF pictureOf(const Renderer& renderer, const Device& device);

/// The value that `fraction` of the others do not exceed: 0.5 is the median. `values` must not be empty.
double percentile(std::vector<double> values, double fraction);

/// Milliseconds of each scope over several submissions.
class StageSamples
{
public:
    struct Stage
    {
        std::string name;
        std::vector<double> ms; // a submission each
    };
    void add(const std::vector<StageTime>& times);
    const std::vector<Stage>& stages() const { return stages_; } // in order of first appearance
    /// The median of a scope, 0 where there is none of that name.
    double median(std::string_view name) const;

private:
    std::vector<Stage> stages_;
};
