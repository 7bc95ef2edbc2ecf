#include "tools/bench/motion_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace
{
using Json = nlohmann::ordered_json;

/// FLIP in pixels that the frame before did not show, in units of the mean; nothing where there is no such pixel.
std::optional<double> unseenFlipRatio(const SequenceMetrics& metrics)
{
    return metrics.unseenFlip().count > 0 && metrics.meanFlip() > 0 ? std::optional(metrics.unseenFlip().value() / metrics.meanFlip())
                                                                    : std::nullopt;
}

template <typename Value>
std::array<double, SequenceMetrics::kDistances> byDistance(const Value& value)
{
    std::array<double, SequenceMetrics::kDistances> values{};
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = value(i + 1);
    return values;
}

Json orNull(const std::optional<double>& value)
{
    return value ? Json(*value) : Json(nullptr);
}
} // namespace

void printJson(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result)
{
    const SequenceMetrics& m = result.metrics;
    Json json{{"schema", "lumicut-bench-motion/1"},
              {"device", opened.device->name()},
              {"package", options.package.filename().string()},
              {"mode", options.mode},
              {"preset", options.preset},
              {"path", options.path},
              {"camera", opened.camera.name},
              {"width", options.width},
              {"height", options.height},
              {"frames", options.frames},
              {"fps", options.frames_per_second},
              {"warm_up", options.warm_up},
              {"spp", options.sample_count},
              {"seed", options.seed},
              {"moving_flip", m.meanFlip()},
              {"flicker", byDistance([&](size_t k) { return m.flicker(k).value(); })},
              {"ghost", result.ghost.all},
              {"reprojected", orNull(result.reprojected)}};
    json["stages_ms"] = Json::object();
    for (const StageSamples::Stage& stage : result.stages.stages())
        json["stages_ms"][stage.name] = percentile(stage.ms, 0.5);
    json["flip_of_frames"] = m.flip();
    json["flicker_plain"] = byDistance([&](size_t k) { return m.plainFlicker(k).value(); });
    json["flicker_of_frames"] = byDistance([&](size_t k) { return m.flicker(k).pictures.value(); });
    json["flicker_of_references"] = byDistance([&](size_t k) { return m.flicker(k).references.value(); });
    json["plain_pixels"] = result.plain.value();
    json["disoccluded_flip_ratio"] = orNull(unseenFlipRatio(m));
    json["disoccluded_pixels"] = m.unseenShare();
    json["ghost_indirect"] = result.ghost.indirect;
    fmt::print("{}\n", json.dump(2));
}

void print(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result)
{
    const SequenceMetrics& m = result.metrics;
    fmt::print("{}, {} triangles, {}x{}, mode {}, preset {}, path {}: {} frames at {} a second after {} of warm-up, against {} samples a pixel\n",
               opened.device->name(), opened.package.triangles().size(), options.width, options.height, options.mode, options.preset,
               options.path, options.frames, options.frames_per_second, options.warm_up, options.sample_count);
    fmt::print("  {:<34} {:8.4f}  (worst frame {:.4f})\n", "moving FLIP", m.meanFlip(), *std::ranges::max_element(m.flip()));
    const auto row = [](std::string_view name, const std::array<double, SequenceMetrics::kDistances>& values)
    { fmt::print("  {:<34} {:8.4f} {:8.4f} {:8.4f}\n", name, values[0], values[1], values[2]); };
    row("flicker F1 F2 F3 over references'", byDistance([&](size_t k) { return m.flicker(k).value(); }));
    row("  without mirrors and caustics", byDistance([&](size_t k) { return m.plainFlicker(k).value(); }));
    row("  of the frames", byDistance([&](size_t k) { return m.flicker(k).pictures.value(); }));
    row("  of the references", byDistance([&](size_t k) { return m.flicker(k).references.value(); }));
    const auto unseen = unseenFlipRatio(m);
    fmt::print("  {:<34} {:>8}  of the mean, in {:.2f} % of the pixels\n", "FLIP where newly seen",
               unseen ? fmt::format("{:.3f}", *unseen) : "-", 100 * m.unseenShare());
    const auto ghost = [](std::string_view name, const std::array<double, 2>& shares)
    { fmt::print("  {:<34} {:8.4f} {:8.4f}\n", name, shares[0], shares[1]); };
    ghost("light left 1 and 4 frames after off", result.ghost.all);
    ghost("  of indirect light", result.ghost.indirect);
    fmt::print("  {:<34} {:>8}\n", "pixels reprojected", result.reprojected ? fmt::format("{:.3f}", *result.reprojected) : "-");
    fmt::print("  {:<34} {:>8}\n", "GPU ms", "p50");
    for (const StageSamples::Stage& stage : result.stages.stages())
        fmt::print("    {:<32} {:8.3f}\n", stage.name, percentile(stage.ms, 0.5));
}
