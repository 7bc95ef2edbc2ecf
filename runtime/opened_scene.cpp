#include "runtime/opened_scene.h"

#include "image/read_exr.h"
#include "runtime/capture.h"

#include <cmath>
#include <future>

namespace
{
Result<Rendering> readAgainst(const PlayerOptions& options)
{
    if (options.against.empty())
        return Rendering{};
    const auto image = readExr(options.against);
    if (!image)
        return image.error().about(options.against.string());
    // A window may have any size; a picture that is written must be one that lumicut-compare could take too.
    if (options.headless && (image->width != options.width || image->height != options.height))
        return Error{ExitCode::kInvalid,
                     fmt::format("has {}x{} pixels, the picture {}x{}; give both one size (--size)", image->width,
                                 image->height, options.width, options.height),
                     options.against.string()};
    Rendering rendering{.width = image->width, .height = image->height};
    for (size_t i = 0; i < image->rgb.size(); i += 3)
        rendering.pixels.push_back({image->rgb[i], image->rgb[i + 1], image->rgb[i + 2]});
    return rendering;
}

Result<std::optional<CameraPath>> readPath(const PlayerOptions& options, const std::vector<Camera>& cameras)
{
    if (options.path.empty())
        return std::optional<CameraPath>();
    auto path = CameraPath::load(options.path, cameras);
    if (!path)
        return path.error();
    return std::optional(std::move(*path));
}

struct OpenedDevice
{
    Instance instance;
    std::unique_ptr<Device> device;
    std::string text; // name and driver
};

Result<OpenedDevice> openDevice(const PlayerOptions& options, std::span<const char* const> window_extensions)
{
    auto instance = Instance::create({.validation = options.validation, .extensions = window_extensions});
    if (!instance)
        return instance.error();
    const std::vector<DeviceInfo> devices = instance->devices();
    const auto index = selectDevice(devices, options.device);
    if (!index)
        return index.error();
    auto device = Device::create(*instance, *index, {.present = !window_extensions.empty()});
    if (!device)
        return device.error();
    return OpenedDevice{std::move(*instance), std::move(*device),
                        fmt::format("{} ({})", devices[*index].name, devices[*index].driver)};
}
} // namespace

Result<OpenedScene> openScene(const PlayerOptions& options, std::span<const char* const> window_extensions,
                              Statistics& statistics)
{
    // The driver takes as long to start as the package to read.
    auto reading = std::async(
        [&]
        {
            auto package =
                statistics.timed(statistics.package_ms, [&] { return package::Package::open(options.package); });
            statistics.open_ms = statistics.elapsedMs();
            return package;
        });
    auto opened = statistics.timed(statistics.device_ms, [&] { return openDevice(options, window_extensions); });
    auto package = reading.get();
    if (!package)
        return package.error();
    auto against = readAgainst(options);
    if (!against)
        return against.error();
    std::vector<Camera> cameras = packageCameras(*package);
    auto path = readPath(options, cameras);
    if (!path)
        return path.error();
    if (!opened)
        return opened.error();
    auto& device = opened->device;
    if (const uint64_t bytes = against->pixels.size() * sizeof(gpu::vec3);
        bytes > device->limits().maxStorageBufferRange)
        return Error{ExitCode::kDevice,
                     fmt::format("of {}x{} pixels is too large to compare with on {}", against->width, against->height,
                                 device->name()),
                     options.against.string()};
    const auto camera = chooseCamera(cameras, options.camera);
    if (!camera)
        return camera.error();
    auto scene = statistics.timed(statistics.upload_ms, [&] { return SceneGpu::create(*device, *package); });
    if (!scene)
        return scene.error();
    std::unique_ptr<package::Package> kept;
    std::unique_ptr<Animation> animation;
    AnimationChoice plays;
    if (package->motion() != nullptr)
    {
        kept = std::make_unique<package::Package>(std::move(*package));
        animation = std::make_unique<Animation>(*device, **scene, *kept);
        const bool single = options.headless && !options.sequence && !options.seconds; // a picture, at rest
        const auto chosen = animation->choose(single && options.animation.empty() ? "none" : options.animation);
        if (!chosen)
            return chosen.error();
        plays = *chosen;
    }
    else if (options.seconds || (!options.animation.empty() && options.animation != "none"))
        return Error{ExitCode::kUsage, "nothing in the package moves; leave --animation and --time out"};
    const std::string preset = !options.preset.empty() ? options.preset : device->isCpu() ? "preview" : "default";
    const auto settings = makeSettings(preset, options.assignments);
    if (!settings)
        return settings.error();
    statistics.ready_ms = statistics.elapsedMs();
    return OpenedScene{.instance = opened->instance,
                       .device = std::move(device),
                       .device_text = std::move(opened->text),
                       .scene = std::move(*scene),
                       .package = std::move(kept),
                       .animation = std::move(animation),
                       .plays = plays,
                       .cameras = std::move(cameras),
                       .camera_index = *camera,
                       .path = std::move(*path),
                       .settings = *settings,
                       .against = std::move(*against)};
}

Camera OpenedScene::pose(Recorder& rec, double seconds) const
{
    if (!animation)
        return camera();
    animation->record(rec, plays, seconds);
    return animation->posed(camera_index, camera());
}

double OpenedScene::animationTime(double seconds) const
{
    const double duration = animation ? animation->duration(plays) : 0;
    return duration > 0 ? seconds - duration * std::floor(seconds / duration) : 0;
}

Result<PictureOrigin> originOf(const OpenedScene& opened, const PlayerOptions& options)
{
    auto origin = frameOrigin(options, opened.settings);
    if (origin)
        origin->device = opened.device_text;
    return origin;
}

Status makeRenderer(std::optional<Renderer>& renderer, const OpenedScene& opened, Mode mode, uint32_t width,
                    uint32_t height, const Settings& settings, bool layers)
{
    renderer.reset(); // its memory first
    if (const Status status = Renderer::checkSize(*opened.device, width, height, mode, settings); !status)
        return status;
    renderer.emplace(*opened.device, *opened.scene, mode, width, height, settings);
    if (layers)
        renderer->keepLayers(*opened.device);
    if (!opened.against.pixels.empty())
        renderer->compareWith(*opened.device, opened.against.pixels, opened.against.width, opened.against.height);
    return Success{};
}

Status writeResults(const PlayerOptions& options, const OpenedScene& opened, Renderer& renderer,
                    const Settings& settings, Statistics& statistics)
{
    statistics.device = opened.device->name();
    statistics.device_bytes = opened.device->allocatedBytes();
    statistics.sample_count = renderer.sampleCount();
    statistics.non_finite_samples = renderer.nonFiniteCount(*opened.device);
    if (const auto store = renderer.photonStore(*opened.device); store && store->photon_count > 0)
    {
        statistics.photons = store->photon_count;
        statistics.photon_paths = store->path_count;
        statistics.photon_paths_asked = settings.photon_count;
    }
    fmt::print(stderr, "{}\n", statistics.summary());
    if (!options.output.empty())
    {
        const auto origin = originOf(opened, options);
        if (!origin)
            return origin.error();
        const Capture picture(options.output, renderer, *opened.device, *opened.scene, settings, options.layers);
        if (const Status status = picture.write(originNotes(*origin)); !status)
            return status.error().about(options.output.string());
    }
    if (!options.stats.empty())
        if (const Status status = statistics.writeJson(options.stats); !status)
            return status.error().about(options.stats.string());
    return Success{};
}
