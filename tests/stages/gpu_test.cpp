#include "tests/stages/gpu_test.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace
{
constexpr uint32_t kFramesPerSubmission = 32;

const Result<std::unique_ptr<Device>>& openedDevice();

void stopBuilding()
{
    if (const auto& opened = openedDevice())
        (*opened)->stopBuilding();
}

const Result<std::unique_ptr<Device>>& openedDevice()
{
    // Never closed: scenes and renderers of any test borrow it, and the end of the process frees everything.
    static const auto* const opened = new Result<std::unique_ptr<Device>>(
        []() -> Result<std::unique_ptr<Device>>
        {
            ::setenv("XDG_CACHE_HOME", LUMICUT_TEST_CACHE, 1); // pipelines are built once for all tests
            const auto instance = Instance::create({.validation = true});
            if (!instance)
                return instance.error();
            const auto index = selectDevice(instance->devices(), "");
            if (!index)
                return index.error();
            auto device = Device::create(*instance, *index);
            std::atexit(stopBuilding); // the driver ends after that, and must not be busy
            return device;
        }());
    return *opened;
}
} // namespace

void GpuTest::SetUpTestSuite()
{
    if (const auto& opened = openedDevice())
        RecordProperty("device", (*opened)->name());
}

void GpuTest::SetUp()
{
    ASSERT_TRUE(openedDevice()) << openedDevice().error().message;
}

const Device& GpuTest::device()
{
    return **openedDevice();
}

std::unique_ptr<SceneGpu> GpuTest::load(const std::filesystem::path& path)
{
    kept_.clear(); // the new scene may come to lie where a former one lay
    const auto package = package::Package::open(path);
    check(bool(package), "{}: {}", path.string(), package ? "" : package.error().message);
    const auto* const origin = package->meta().origin();
    origin_ = origin ? gpu::vec3{float(origin->x()), float(origin->y()), float(origin->z())} : gpu::vec3{};
    auto scene = SceneGpu::create(device(), *package);
    check(bool(scene), "{}: {}", path.string(), scene ? "" : scene.error().message);
    return std::move(*scene);
}

Renderer& GpuTest::rendererFor(const SceneGpu& scene, Mode mode, uint32_t width, uint32_t height)
{
    for (const auto& kept : kept_)
        if (kept->scene == &scene && kept->mode == mode && kept->renderer.width() == width &&
            kept->renderer.height() == height)
        {
            kept->renderer.restart();
            return kept->renderer;
        }
    kept_.push_back(std::make_unique<Kept>(&scene, mode, Renderer(device(), scene, mode, width, height)));
    return kept_.back()->renderer;
}

void GpuTest::expectGroups(const gpu::QueueSize& size)
{
    for (const auto& [row, group_size] : {std::pair(0, 64.0), std::pair(1, 128.0), std::pair(2, 256.0)})
    {
        EXPECT_EQ(size.groups[row].x, uint32_t(std::ceil(size.count / group_size)))
            << size.count << " in groups of " << group_size;
        EXPECT_EQ(size.groups[row].y, 1u);
        EXPECT_EQ(size.groups[row].z, 1u);
    }
}

Picture GpuTest::render(const SceneGpu& scene, const Camera& camera, const Settings& settings, uint32_t sample_count,
                        uint32_t width, uint32_t height, Mode mode, uint32_t seed)
{
    Renderer& renderer = rendererFor(scene, mode, width, height);
    Recorder rec(device());
    uint32_t left = sample_count;
    while (left > 0)
    {
        rec.begin(scene.descriptorSet());
        for (uint32_t frame = 0; frame < kFramesPerSubmission && left > 0; ++frame)
        {
            const uint32_t count = std::min(left, renderer.maxBatch());
            renderer.record(rec, camera, settings, seed, count);
            left -= count;
        }
        rec.submitAndWait();
    }
    EXPECT_EQ(renderer.sampleCount(), sample_count);
    EXPECT_EQ(renderer.nonFiniteCount(device()), 0u);
    return {.width = width, .height = height, .pixels = renderer.picture(device())};
}
