// The frame as a whole: equal input gives equal bits, how samples are batched does not show, and what measurements need.
#include "tests/stages/gpu_test.h"
#include "tests/stages/same_picture.h"
#include "tests/stages/scene_builder.h"

#include <cmath>
#include <cstring>

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 40;

/// A room with a lamp, a mirror, glossy metal and glass; `translucent` adds a blended sheet, met by chance.
std::filesystem::path room(SceneBuilder& scene, bool translucent)
{
    const auto metal = [](double roughness)
    {
        return nlohmann::json{
            {"pbrMetallicRoughness", {{"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"roughnessFactor", roughness}}}};
    };
    scene.box({-1, 0, -1}, {1, 2, 1}, scene.material(lambert(0.6)), true);
    scene.quad({-0.3f, 1.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, scene.material(emitter(8)));
    scene.sphere({-0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0)));
    scene.sphere({0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0.4)));
    scene.sphere({0, 0.9f, 0}, 0.25f, 12, true,
                 scene.material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                                 {"extensions",
                                  {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                   {"KHR_materials_volume", {{"thicknessFactor", 0.5}}}}}}));
    if (translucent)
        scene.quad({-0.8f, 0.3f, 0.4f}, {1.6f, 0, 0}, {0, 1, 0},
                   scene.material(
                       with(lambert(0.5), {{"alphaMode", "BLEND"},
                                           {"pbrMetallicRoughness", {{"baseColorFactor", {0.2, 0.4, 0.8, 0.4}}}}})));
    return scene.compile();
}

const Camera kCamera{.name = "",
                     .position = {0, 1, 0.95f},
                     .forward = {0, 0, -1},
                     .up = {0, 1, 0},
                     .vertical_fov = 1.2f,
                     .orthographic_height = 0};

bool equalBits(const std::vector<gpu::vec3>& a, const std::vector<gpu::vec3>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(gpu::vec3)) == 0;
}

class RendererTest : public GpuTest, public testing::WithParamInterface<Mode>
{
};

TEST_P(RendererTest, GivesTheSameBitsForTheSameSeedAndOthersForAnother)
{
    SceneBuilder builder;
    const auto scene = load(room(builder, true));
    const auto picture = [&](uint32_t seed)
    { return render(*scene, kCamera, Settings(), 4, kWidth, kHeight, GetParam(), seed).pixels; };
    const auto first = picture(1);
    EXPECT_TRUE(equalBits(first, picture(1)));
    EXPECT_FALSE(equalBits(first, picture(2)));
}

TEST_P(RendererTest, StartsAnewWithTheCameraWithTheSeedAndWhenAsked)
{
    SceneBuilder builder;
    const auto scene = load(room(builder, true));
    Renderer renderer(device(), *scene, GetParam(), kWidth, kHeight);
    Recorder rec(device());
    const auto record = [&](const Camera& camera, uint32_t seed)
    {
        rec.begin(scene->descriptorSet());
        renderer.record(rec, camera, Settings(), seed);
        rec.submitAndWait();
        return renderer.picture(device());
    };
    const auto first = record(kCamera, 1), two_samples = record(kCamera, 1);
    EXPECT_EQ(renderer.sampleCount(), 2u);
    EXPECT_FALSE(equalBits(first, two_samples));
    Camera moved = kCamera;
    moved.position.x += 0.1f;
    (void)record(moved, 1);
    EXPECT_EQ(renderer.sampleCount(), 1u);
    EXPECT_TRUE(equalBits(first, record(kCamera, 1)));
    EXPECT_EQ(renderer.sampleCount(), 1u);
    (void)record(kCamera, 2);
    EXPECT_EQ(renderer.sampleCount(), 1u);
    (void)record(kCamera, 1);
    renderer.restart();
    EXPECT_TRUE(equalBits(first, record(kCamera, 1)));
    EXPECT_EQ(renderer.sampleCount(), 1u);
}

INSTANTIATE_TEST_SUITE_P(, RendererTest, testing::Values(Mode::kDirect, Mode::kReference),
                         [](const auto& mode) { return mode.param == Mode::kDirect ? "Direct" : "Reference"; });

/// Of the same samples, only that what the eye sees shine is added last.
TEST_F(GpuTest, FilteredPathsAreTheReferenceWhereNothingIsFiltered)
{
    SceneBuilder builder;
    builder.box({-1, 0, -1}, {1, 2, 1}, builder.material(lambert(0.6)), true);
    builder.quad({-0.3f, 1.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, builder.material(emitter(8)));
    const auto scene = load(builder.compile());
    const Settings plain{.denoise_passes = 0, .history_frames = 0, .antialias_frames = 0};
    const auto picture = [&](Mode mode, const Settings& settings)
    { return render(*scene, kCamera, settings, 1, kWidth, kHeight, mode, 1).pixels; };
    const auto reference = picture(Mode::kReference, plain), paths = picture(Mode::kFilteredPaths, plain);
    for (size_t i = 0; i < reference.size(); ++i)
        EXPECT_NEAR(paths[i].x, reference[i].x, 1e-6 * reference[i].x) << i; // roundings of a handful of sums
    EXPECT_FALSE(equalBits(paths, picture(Mode::kFilteredPaths, Settings())));
}

class Batches : public GpuTest
{
protected:
    /// Sums of `sample_count` samples a pixel by the reference stage, `batch` at a time.
    static std::vector<gpu::vec3> sums(const SceneGpu& scene, uint32_t sample_count, uint32_t batch, uint32_t seed = 0)
    {
        constexpr uint32_t kPixels = kWidth * kHeight;
        const RayStage rays(device(), scene);
        const ReferenceStage reference(device(), scene, kPixels, batch);
        ResolveStage resolve(device(), kPixels);
        gpu::CameraParams view = cameraParams(kCamera, kWidth, kHeight);
        view.sample_count = batch;
        view.seed = seed;
        Recorder rec(device());
        for (view.first_sample = 0; view.first_sample < sample_count; view.first_sample += batch)
        {
            rec.begin(scene.descriptorSet());
            if (view.first_sample == 0)
                resolve.restart(rec);
            resolve.accumulate(rec, reference.record(rec, rays, {.camera = view, .depth_limit = 16}), kPixels, batch);
            rec.submitAndWait();
        }
        return device().download<gpu::vec3>(resolve.sum(), kPixels);
    }
};

TEST_F(Batches, OfAnySizeGiveTheSameBitsWithoutTranslucency)
{
    SceneBuilder builder;
    const auto scene = load(room(builder, false));
    const auto one_by_one = sums(*scene, 12, 1);
    for (const uint32_t batch : {2u, 3u, 12u})
        EXPECT_TRUE(equalBits(one_by_one, sums(*scene, 12, batch))) << batch;
}

TEST_F(Batches, OfAnySizeAgreeStatisticallyWithTranslucency)
{
    // Blended surfaces are met by other random numbers in another batch: sums differ, but by noise alone.
    SceneBuilder builder;
    const auto scene = load(room(builder, true));
    constexpr uint32_t kSamples = 8, kSeeds = 6;
    const auto pictures = [&](uint32_t batch, uint32_t first_seed)
    {
        std::vector<ImageF> images;
        for (uint32_t seed = first_seed; seed < first_seed + kSeeds; ++seed)
            images.push_back(imageOf(kWidth, kHeight, sums(*scene, kSamples, batch, seed)));
        return images;
    };
    const auto one_by_one = pictures(1, 0);
    EXPECT_FALSE(equalBits(sums(*scene, kSamples, 1), sums(*scene, kSamples, 4)));
    for (const uint32_t batch : {4u, 8u})
        expectSamePicture(fmt::format("batches of {}", batch), pictures(batch, batch * kSeeds), one_by_one, 0.02);
}

class Measured : public GpuTest
{
protected:
    /// A floor alone under a sun that shines straight down.
    std::unique_ptr<SceneGpu> sunlitFloor(SceneBuilder& scene, double lux)
    {
        scene.floor(2, 0, scene.material(lambert(0.5)));
        scene.light({{"type", "directional"}, {"intensity", lux}},
                    {{"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
        package_ = scene.compile();
        return load(package_);
    }
    std::filesystem::path package_;
    Camera down_{.name = "",
                 .position = {0, 1, 0},
                 .forward = {0, -1, 0},
                 .up = {0, 0, -1},
                 .vertical_fov = 1,
                 .orthographic_height = 0};
};

TEST_F(Measured, LightSetOnTheDeviceIsTheOneThatShines)
{
    SceneBuilder builder;
    const auto scene = sunlitFloor(builder, 3);
    const auto package = package::Package::open(package_);
    ASSERT_TRUE(package);
    Renderer renderer(device(), *scene, Mode::kDirect, kWidth, kHeight);
    Recorder rec(device());
    const auto picture = [&](const gpu::Light* light)
    {
        rec.begin(scene->descriptorSet());
        renderer.restart();
        renderer.record(rec, down_, Settings(), 1); // kernels that read the light before it is written
        if (light)
            scene->setLight(rec, 0, *light);
        renderer.restart();
        renderer.record(rec, down_, Settings(), 1);
        rec.submitAndWait();
        return renderer.picture(device());
    };
    gpu::Light light = package->lights()[0];
    const auto before = picture(nullptr);
    light.emission = 2.0f * light.emission;
    const auto doubled = picture(&light);
    uint32_t wrong = 0;
    for (size_t i = 0; i < before.size(); ++i) // twice a float is exact
        wrong += doubled[i].x != 2 * before[i].x || before[i].x <= 0;
    EXPECT_EQ(wrong, 0u);
    EXPECT_TRUE(equalBits(doubled, picture(nullptr))) << "it stays as it was set";
}

TEST_F(Measured, RaysAreCountedByScopeAndKind)
{
    SceneBuilder builder;
    const auto scene = sunlitFloor(builder, 3);
    Renderer renderer(device(), *scene, Mode::kDirect, kWidth, kHeight);
    RayTally tally(device());
    renderer.countRays(&tally);
    Recorder rec(device());
    Settings settings;
    settings.direct_samples = 3;
    rec.begin(scene->descriptorSet());
    renderer.record(rec, down_, settings, 1);
    rec.submitAndWait();
    const auto entries = tally.entries();
    ASSERT_EQ(entries.size(), 2u); // no light with an area: no BSDF-sampled rays
    EXPECT_EQ(entries[0].scope, "primary");
    EXPECT_FALSE(entries[0].any_hit);
    EXPECT_EQ(entries[0].ray_count, kWidth * kHeight);
    EXPECT_EQ(entries[1].scope, "direct");
    EXPECT_TRUE(entries[1].any_hit);
    EXPECT_EQ(entries[1].ray_count, 3 * kWidth * kHeight); // the floor fills the picture

    const auto package = package::Package::open(package_);
    ASSERT_TRUE(package);
    gpu::Light below = package->lights()[0];
    below.p1 = {-below.p1.x, -below.p1.y, -below.p1.z};
    RayTally dark(device());
    renderer.countRays(&dark);
    rec.begin(scene->descriptorSet());
    scene->setLight(rec, 0, below);
    renderer.record(rec, down_, settings, 1);
    rec.submitAndWait();
    ASSERT_EQ(dark.entries().size(), 2u);
    EXPECT_EQ(dark.entries()[1].ray_count, 0u) << "no ray goes to a sun behind the floor";
}

/// Memory that a renderer of mode gi takes for pictures of 1920 x 1080, bytes.
uint64_t rendererBytes(const Device& device, const SceneGpu& scene)
{
    const uint64_t before = device.allocatedBytes();
    const Renderer renderer(device, scene, Mode::kGi, 1920, 1080);
    return device.allocatedBytes() - before;
}

class RendererMemory : public GpuTest
{
};

TEST_F(RendererMemory, IsLessThanAGibibyteForAPictureOf1080Lines)
{
    SceneBuilder builder;
    builder.box({-1, 0, -1}, {1, 2, 1}, builder.material(lambert(0.6)), true);
    builder.quad({-0.3f, 1.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, builder.material(emitter(8)));
    builder.sphere({0, 0.5f, 0}, 0.3f, 12, true,
                   builder.material({{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.4}}}}));
    const auto scene = load(builder.compile());
    ASSERT_FALSE(scene->hasSmoothLayers()); // which take two points a pixel
    EXPECT_LE(rendererBytes(device(), *scene), uint64_t(1) << 30);
}

TEST_F(RendererMemory, IsAllocatedAndPipelinesAreBuiltBeforeTheThirdFrame)
{
    SceneBuilder builder;
    const auto scene = load(room(builder, true));
    const Settings settings = *presetSettings("preview");
    Renderer renderer(device(), *scene, Mode::kGi, kWidth, kHeight, settings);
    Recorder rec(device());
    uint64_t allocations = 0, pipelines = 0;
    for (uint32_t frame = 0; frame < 8; ++frame)
    {
        Camera camera = kCamera;
        camera.position.x += 0.01f * float(std::min(frame, 5u)); // stands at last
        rec.begin(scene->descriptorSet());
        renderer.record(rec, camera, settings, 0);
        renderer.display(rec, settings, false);
        rec.submitAndWait();
        if (frame == 1)
        {
            allocations = device().allocationCount();
            pipelines = device().pipelineCount();
        }
    }
    EXPECT_EQ(device().allocationCount(), allocations);
    EXPECT_EQ(device().pipelineCount(), pipelines);
}
} // namespace
