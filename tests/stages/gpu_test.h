// The fixture of tests that run on a Vulkan device, opened once and with the validation layers: a message of theirs
// ends the test program. Where there is no device the tests fail; they are never skipped.
#pragma once
#include "runtime/renderer.h"

#include <gtest/gtest.h>

#include <filesystem>

/// Mean linear radiance, rows from the top.
struct Picture
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<gpu::vec3> pixels; // [width * height]
};

class GpuTest : public testing::Test
{
protected:
    static void SetUpTestSuite();
    void SetUp() override;

    static const Device& device();

    /// Expects the dispatches of every row to cover the count, and no group more.
    static void expectGroups(const gpu::QueueSize& size);

    /// A package's scene on the device. Aborts where there is none: that is the test's mistake.
    std::unique_ptr<SceneGpu> load(const std::filesystem::path& package);
    /// A place of the source in the package that was loaded last: the compiler moves far scenes to the origin.
    gpu::vec3 inPackage(gpu::vec3 source) const
    {
        return {source.x - origin_.x, source.y - origin_.y, source.z - origin_.z};
    }

    /// Renders `sample_count` samples a pixel, and expects none of them to be NaN or infinite.
    /// @param scene from load()
    Picture render(const SceneGpu& scene, const Camera& camera, const Settings& settings, uint32_t sample_count,
                   uint32_t width, uint32_t height, Mode mode, uint32_t seed = 0);

private:
    Renderer& rendererFor(const SceneGpu& scene, Mode mode, uint32_t width, uint32_t height);

    struct Kept // the renderer used last: making its pipelines takes longer than most pictures
    {
        const SceneGpu* scene;
        Mode mode;
        Renderer renderer;
    };
    std::vector<std::unique_ptr<Kept>> kept_; // of scenes since the last load()
    gpu::vec3 origin_{};
};
