#include "tools/bench/opened.h"

#include "tools/compare/metrics.h"

#include <algorithm>

Result<OpenedPackage> openPackage(const BenchOptions& options, bool kernel_statistics)
{
    auto package = package::Package::open(options.package);
    if (!package)
        return package.error();
    const std::vector<Camera> cameras = packageCameras(*package);
    const auto camera = chooseCamera(cameras, options.camera);
    if (!camera)
        return camera.error();
    const auto instance = Instance::create({});
    if (!instance)
        return instance.error();
    const auto index = selectDevice(instance->devices(), options.device);
    if (!index)
        return index.error();
    auto device = Device::create(*instance, *index, {.kernel_statistics = kernel_statistics});
    if (!device)
        return device.error();
    auto scene = SceneGpu::create(**device, *package);
    if (!scene)
        return scene.error();
    return OpenedPackage{.package = std::move(*package),
                         .device = std::move(*device),
                         .scene = std::move(*scene),
                         .camera = cameras[*camera]};
}

ImageF pictureOf(const Renderer& renderer, const Device& device)
{
    ImageF image{renderer.width(), renderer.height(), {}};
    for (const gpu::vec3& pixel : renderer.picture(device))
        image.rgb.insert(image.rgb.end(), {pixel.x, pixel.y, pixel.z});
    blackenNonFinite(image);
    return image;
}

double percentile(std::vector<double> values, double fraction)
{
    std::ranges::sort(values);
    return values[std::min(values.size() - 1, size_t(double(values.size()) * fraction))];
}

void StageSamples::add(const std::vector<StageTime>& times)
{
    for (const StageTime& time : times)
    {
        auto stage = std::ranges::find(stages_, time.name, &Stage::name);
        if (stage == stages_.end())
            stage = stages_.insert(stages_.end(), Stage{.name = time.name, .ms = {}});
        stage->ms.push_back(time.ms);
    }
}

double StageSamples::median(std::string_view name) const
{
    const auto stage = std::ranges::find(stages_, name, &Stage::name);
    return stage == stages_.end() ? 0 : percentile(stage->ms, 0.5);
}
