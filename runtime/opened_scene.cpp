#include "runtime/opened_scene.h"

#include "runtime/capture.h"

Result<OpenedScene> openScene(const PlayerOptions& options, std::span<const char* const> window_extensions,
                              Statistics& statistics)
{
    auto package = package::Package::open(options.package);
    if (!package)
        return package.error();
    statistics.open_ms = statistics.elapsedMs();

    auto instance = Instance::create({.validation = options.validation, .extensions = window_extensions});
    if (!instance)
        return instance.error();
    const auto index = selectDevice(instance->devices(), options.device);
    if (!index)
        return index.error();
    auto device = Device::create(*instance, *index, !window_extensions.empty());
    if (!device)
        return device.error();
    const auto camera = chooseCamera(*package, options.camera);
    if (!camera)
        return camera.error();
    auto scene = SceneGpu::create(**device, *package);
    if (!scene)
        return scene.error();
    const std::string preset = !options.preset.empty() ? options.preset : (*device)->isCpu() ? "preview" : "default";
    const auto settings = makeSettings(preset, options.assignments);
    if (!settings)
        return settings.error();
    return OpenedScene{.instance = *instance,
                       .device = std::move(*device),
                       .scene = std::move(*scene),
                       .cameras = packageCameras(*package),
                       .camera = *camera,
                       .settings = *settings};
}

Status writeResults(const PlayerOptions& options, const OpenedScene& opened, Renderer& renderer, const Settings& settings,
                    Statistics& statistics)
{
    statistics.device = opened.device->name();
    statistics.device_bytes = opened.device->allocatedBytes();
    statistics.sample_count = renderer.sampleCount();
    statistics.non_finite_samples = renderer.nonFiniteCount(*opened.device);
    fmt::print(stderr, "{}\n", statistics.summary());
    if (!options.output.empty())
        if (const Status status = capture(options.output, renderer, *opened.device, *opened.scene, settings); !status)
            return status.error().about(options.output.string());
    if (!options.stats.empty())
        if (const Status status = statistics.writeJson(options.stats); !status)
            return status.error().about(options.stats.string());
    return Success{};
}
