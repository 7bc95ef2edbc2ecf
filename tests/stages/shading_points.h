// The shading points of a small picture, on the GPU as the primary stage leaves them, and here in double precision.
#pragma once
#include "runtime/camera.h"
#include "runtime/stages/primary.h"
#include "tests/stages/gi_test.h"

struct ShadingPoints
{
    /// What `camera` sees. @param path the scene's package
    ShadingPoints(const Device& device, const SceneGpu& scene, const std::filesystem::path& path, const Camera& camera,
                  uint32_t width, uint32_t height);

    struct Point
    {
        bool exists;              // not the background
        Double3 position, normal; // metres; smooth normal on the viewer's side
        Double3 diffuse;          // base colour of what is not metal
        Double3 throughput;
    };
    uint32_t width, height;
    PrimaryStage stage;
    Buffer emission; // vec3[width * height]
    std::optional<SurfaceBuffers> gpu;
    std::vector<Point> points; // [width * height]
};
