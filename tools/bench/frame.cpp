#include "tools/bench/frame.h"

#include "runtime/renderer.h"
#include "tools/bench/changing_lights.h"
#include "tools/bench/kernels.h"
#include "tools/bench/paths.h"
#include "tools/bench/played_animation.h"
#include "tools/bench/rays.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <optional>

namespace
{
struct Measurement
{
    std::string motion;
    StageSamples stages;
    std::vector<double> record_ms, wall_ms;     // on the CPU: recording; from its begin to the finished frame
    std::vector<double> pose_ms;                // of recording: what moves; empty where nothing does
    uint64_t device_bytes = 0, scene_bytes = 0; // of GPU memory: all, and what the scene itself takes
    std::vector<RayTally::Entry> rays;          // of one frame
    std::optional<CommandSamples> commands;
};

double since(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Measurement measure(const OpenedPackage& opened, PlayedAnimation& animation, const FrameBenchOptions& options)
{
    const Mode mode = options.mode == "gi" ? Mode::kGi : options.mode == "direct" ? Mode::kDirect : Mode::kReference;
    SceneGpu& scene = *opened.scene;
    const uint64_t scene_bytes = opened.device->allocatedBytes();
    Renderer renderer(*opened.device, scene, mode, options.width, options.height, options.settings);
    Recorder rec(*opened.device);
    const bool camera_moves = options.moving == "both" || options.moving == "camera";
    const bool lights_move = options.moving == "both" || options.moving == "lights";
    const auto lights = opened.package.lights();
    const uint32_t light = lights_move ? chooseMovingLight(lights).value_or(gpu::kNone) : gpu::kNone;
    Measurement result;
    result.motion =
        fmt::format("{}; {}", camera_moves ? "the camera moves" : "the camera stands still",
                    !lights_move          ? "lights stand still"
                    : light == gpu::kNone ? "no light can move, there is no directional, point or spot light"
                    : lights[light].kind == gpu::kLightDirectional ? "a directional light moves"
                                                                   : "a point or spot light moves");
    const auto record = [&](uint32_t frame)
    {
        rec.begin(scene.descriptorSet());
        const auto scope = rec.scope("frame");
        const auto start = std::chrono::steady_clock::now();
        animation.show(rec, int32_t(frame));
        const double pose_ms = since(start);
        if (light != gpu::kNone)
            scene.setLight(rec, light, movedLight(lights[light], scene.info(), int32_t(frame)));
        renderer.record(rec, camera_moves ? movedCamera(opened.camera, scene.info(), float(frame)) : opened.camera,
                        options.settings, 0);
        renderer.display(rec, options.settings, false);
        return pose_ms;
    };
    const uint32_t end =
        options.warm_up + 2 * options.frames; // in turn: as players show them, and with their stages timed
    for (uint32_t frame = 0; frame < end; ++frame)
    {
        const bool stages = frame >= options.warm_up && (frame - options.warm_up) % 2 == 1;
        rec.timeScopes(stages);
        const auto start = std::chrono::steady_clock::now();
        const double pose_ms = record(frame);
        const double record_ms = since(start);
        std::vector<StageTime> times = rec.submitAndWait();
        if (frame < options.warm_up)
            continue;
        if (stages)
        {
            times[0].name = "stages in turn";
            result.stages.add(times);
            continue;
        }
        result.record_ms.push_back(record_ms);
        if (!options.animation.empty())
            result.pose_ms.push_back(pose_ms);
        result.wall_ms.push_back(since(start));
        result.stages.add(times);
    }
    result.device_bytes = opened.device->allocatedBytes();
    result.scene_bytes = scene_bytes;

    if (options.kernels)
        result.commands = CommandSamples::measure(*opened.device, rec, record, end, options.frames);

    RayTally tally(*opened.device); // on a frame of its own: counting takes time
    renderer.countRays(&tally);
    record(options.warm_up + options.frames / 2);
    rec.submitAndWait();
    result.rays = tally.entries();
    return result;
}

RayThroughput::Kind kindOf(const RayTally::Entry& rays)
{
    return rays.any_hit              ? RayThroughput::kDiffuseAnyHit
           : rays.scope == "primary" ? RayThroughput::kPrimary
                                     : RayThroughput::kDiffuse;
}

/// Milliseconds that tracing the rays alone would take at the measured throughput.
double floorMs(const RayTally::Entry& rays, const RayThroughput& throughput)
{
    return double(rays.ray_count) / throughput.megaraysPerSecond(kindOf(rays)) * 1e-3;
}

double floorMs(const Measurement& result, const RayThroughput& throughput)
{
    double ms = 0;
    for (const RayTally::Entry& rays : result.rays)
        ms += floorMs(rays, throughput);
    return ms;
}

void printJson(const FrameBenchOptions& options, const OpenedPackage& opened, const Measurement& result,
               const RayThroughput& throughput)
{
    const auto times = [](const std::vector<double>& ms) {
        return nlohmann::ordered_json{{"p50_ms", percentile(ms, 0.5)}, {"p95_ms", percentile(ms, 0.95)}};
    };
    nlohmann::ordered_json json{{"schema", "lumicut-bench-frame/1"},
                                {"device", opened.device->name()},
                                {"package", options.package.filename().string()},
                                {"mode", options.mode},
                                {"motion", result.motion},
                                {"width", options.width},
                                {"height", options.height},
                                {"frames", options.frames},
                                {"triangles", opened.package.triangles().size()},
                                {"device_bytes", result.device_bytes},
                                {"scene_bytes", result.scene_bytes},
                                {"cpu_record", times(result.record_ms)},
                                {"cpu_wall", times(result.wall_ms)}};
    if (!result.pose_ms.empty())
        json["cpu_pose"] = times(result.pose_ms);
    json["stages"] = nlohmann::ordered_json::array();
    for (const StageSamples::Stage& stage : result.stages.stages())
    {
        nlohmann::ordered_json entry{{"name", stage.name}};
        entry.update(times(stage.ms));
        json["stages"].push_back(entry);
    }
    json["mrays_per_s"] = {{"primary", throughput.megaraysPerSecond(RayThroughput::kPrimary)},
                           {"diffuse", throughput.megaraysPerSecond(RayThroughput::kDiffuse)},
                           {"diffuse_any_hit", throughput.megaraysPerSecond(RayThroughput::kDiffuseAnyHit)}};
    json["rays"] = nlohmann::ordered_json::array();
    for (const RayTally::Entry& rays : result.rays)
        json["rays"].push_back({{"stage", rays.scope},
                                {"any_hit", rays.any_hit},
                                {"count", rays.ray_count},
                                {"floor_ms", floorMs(rays, throughput)}});
    json["floor_ms"] = floorMs(result, throughput);
    if (result.commands)
        json["commands"] = result.commands->json();
    fmt::print("{}\n", json.dump(2));
}

void print(const FrameBenchOptions& options, const OpenedPackage& opened, const Measurement& result,
           const RayThroughput& throughput)
{
    fmt::print("{}, {} triangles, {}x{}, mode {}, {} frames after {} of warm-up: {}\n", opened.device->name(),
               opened.package.triangles().size(), options.width, options.height, options.mode, options.frames,
               options.warm_up, result.motion);
    const auto row = [](const std::string& name, const std::vector<double>& ms)
    { fmt::print("  {:<20} {:10.3f} {:10.3f}\n", name, percentile(ms, 0.5), percentile(ms, 0.95)); };
    fmt::print("  {:<20} {:>10} {:>10}\n", "GPU ms", "p50", "p95");
    for (const StageSamples::Stage& stage : result.stages.stages())
        row(stage.name, stage.ms);
    row("CPU: recording", result.record_ms);
    if (!result.pose_ms.empty())
        row("CPU: of it, posing", result.pose_ms);
    row("CPU: whole frame", result.wall_ms);
    fmt::print("  device memory {:.1f} MiB, of which the scene {:.1f}\n", double(result.device_bytes) / (1 << 20),
               double(result.scene_bytes) / (1 << 20));
    fmt::print("  {:<20} {:>10} {:>12} {:>10}\n", "rays of a frame", "count", "Mrays/s", "floor ms");
    for (const RayTally::Entry& rays : result.rays)
        fmt::print("  {:<20} {:>10} {:>12.2f} {:>10.3f}\n", rays.scope + (rays.any_hit ? " (shadow)" : ""),
                   rays.ray_count, throughput.megaraysPerSecond(kindOf(rays)), floorMs(rays, throughput));
    const double floor = floorMs(result, throughput), frame = result.stages.median("frame");
    fmt::print("  tracing them alone would take {:.3f} ms, {:.1f} % of the median frame\n", floor, 100 * floor / frame);
    if (result.commands)
        result.commands->print();
}
} // namespace

Status benchFrame(const FrameBenchOptions& options)
{
    const auto opened = openPackage(options, options.kernels);
    if (!opened)
        return opened.error();
    if (const Status status = Renderer::checkSize(*opened->device, options.width, options.height); !status)
        return status;
    constexpr uint32_t kRepeats = 10; // of the measurement of throughput
    const auto throughput =
        measureRays(*opened->device, *opened->scene, opened->camera, options.width, options.height, kRepeats);
    if (!throughput)
        return throughput.error();
    auto animation = PlayedAnimation::create(*opened, options.animation, 60);
    if (!animation)
        return animation.error();
    const Measurement result = measure(*opened, *animation, options);
    (options.json ? printJson : print)(options, *opened, result, *throughput);
    return Success{};
}
