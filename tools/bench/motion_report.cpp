#include "tools/bench/motion_report.h"

#include "format/check.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace
{
using Json = nlohmann::ordered_json;

/// FLIP in pixels that the frame before did not show, in units of the mean; nothing where there is no such pixel.
std::optional<double> unseenFlipRatio(const SequenceMetrics& metrics)
{
    return metrics.unseenFlip().count > 0 && metrics.meanFlip() > 0
               ? std::optional(metrics.unseenFlip().value() / metrics.meanFlip())
               : std::nullopt;
}

/// For each distance a part of its flicker; nothing where the sequence is too short or no surface was seen twice.
using Distances = std::array<std::optional<double>, SequenceMetrics::kDistances>;

template <typename Part>
Distances flickers(const SequenceMetrics& metrics, const Part& part, bool plain = false)
{
    Distances values;
    for (size_t i = 0; i < values.size(); ++i)
        if (const Flicker& f = plain ? metrics.plainFlicker(i + 1) : metrics.flicker(i + 1); f.pictures.count > 0)
            values[i] = part(f);
    return values;
}

double over(const Flicker& f)
{
    return f.value();
}
double ofPictures(const Flicker& f)
{
    return f.pictures.value();
}
double ofReferences(const Flicker& f)
{
    return f.references.value();
}

Json orNull(const std::optional<double>& value)
{
    return value ? Json(*value) : Json(nullptr);
}
template <size_t kCount>
Json orNull(const std::array<std::optional<double>, kCount>& values)
{
    Json json = Json::array();
    for (const auto& value : values)
        json.push_back(orNull(value));
    return json;
}

/// Nothing where a value is not a number.
std::array<std::optional<double>, 3> known(const std::array<double, 3>& values)
{
    std::array<std::optional<double>, 3> of_channels;
    for (size_t i = 0; i < 3; ++i)
        if (!std::isnan(values[i]))
            of_channels[i] = values[i];
    return of_channels;
}

std::string text(const std::optional<double>& value)
{
    return value ? fmt::format("{:.4f}", *value) : "-";
}

template <size_t kCount>
void printRow(std::string_view name, const std::array<std::optional<double>, kCount>& values)
{
    fmt::print("  {:<34}", name);
    for (const auto& value : values)
        fmt::print(" {:>8}", text(value));
    fmt::print("\n");
}
} // namespace

void LightSums::add(const ImageF& picture, const ImageF& reference)
{
    check(picture.rgb.size() == reference.rgb.size(), "{} and {} values", picture.rgb.size(), reference.rgb.size());
    for (size_t i = 0; i < picture.rgb.size(); ++i)
    {
        pictures[i % 3] += double(picture.rgb[i]);
        references[i % 3] += double(reference.rgb[i]);
    }
}

std::array<double, 3> LightSums::ratio() const
{
    std::array<double, 3> of_channels;
    for (size_t i = 0; i < 3; ++i)
        of_channels[i] = references[i] > 0 ? pictures[i] / references[i] : std::nan("");
    return of_channels;
}

void printJson(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result)
{
    const SequenceMetrics& m = result.metrics;
    Json json{{"schema", "lumicut-bench-motion/1"},
              {"device", opened.device->name()},
              {"package", options.package.filename().string()},
              {"mode", options.mode},
              {"preset", options.preset},
              {"path", options.path},
              {"lights", options.lights},
              {"camera", opened.camera.name},
              {"width", options.width},
              {"height", options.height},
              {"frames", options.frames},
              {"fps", options.frames_per_second},
              {"warm_up", options.warm_up},
              {"spp", options.sample_count},
              {"seed", options.seed},
              {"moving_flip", m.meanFlip()},
              {"flicker", orNull(flickers(m, over))},
              {"ghost", orNull(result.ghost.all)},
              {"reprojected", orNull(result.reprojected)}};
    json["stages_ms"] = Json::object();
    for (const StageSamples::Stage& stage : result.stages.stages())
        json["stages_ms"][stage.name] = percentile(stage.ms, 0.5);
    json["flip_of_frames"] = m.flip();
    json["flicker_plain"] = orNull(flickers(m, over, true));
    json["flicker_of_frames"] = orNull(flickers(m, ofPictures));
    json["flicker_of_references"] = orNull(flickers(m, ofReferences));
    json["plain_pixels"] = result.plain.value();
    json["disoccluded_flip_ratio"] = orNull(unseenFlipRatio(m));
    json["disoccluded_pixels"] = m.unseenShare();
    json["mean_ratio"] = orNull(known(result.light.ratio()));
    json["ghost_indirect"] = orNull(result.ghost.indirect);
    fmt::print("{}\n", json.dump(2));
}

void print(const MotionBenchOptions& options, const OpenedPackage& opened, const MotionResult& result)
{
    const SequenceMetrics& m = result.metrics;
    fmt::print("{}, {} triangles, {}x{}, mode {}, preset {}, path {}, lights {}: {} frames at {} a second after {} of "
               "warm-up, "
               "against {} samples a pixel\n",
               opened.device->name(), opened.package.triangles().size(), options.width, options.height, options.mode,
               options.preset, options.path, options.lights, options.frames, options.frames_per_second, options.warm_up,
               options.sample_count);
    fmt::print("  {:<34} {:8.4f}  (worst frame {:.4f})\n", "moving FLIP", m.meanFlip(),
               *std::ranges::max_element(m.flip()));
    printRow("mean ratio, red green blue", known(result.light.ratio()));
    printRow("flicker F1 F2 F3 over references'", flickers(m, over));
    printRow("  without mirrors and caustics", flickers(m, over, true));
    printRow("  of the frames", flickers(m, ofPictures));
    printRow("  of the references", flickers(m, ofReferences));
    fmt::print("  {:<34} {:>8}  of the mean, in {:.2f} % of the pixels\n", "FLIP where newly seen",
               text(unseenFlipRatio(m)), 100 * m.unseenShare());
    printRow("light left 1 and 4 frames after off", result.ghost.all);
    printRow("  of indirect light", result.ghost.indirect);
    fmt::print("  {:<34} {:>8}\n", "pixels reprojected", text(result.reprojected));
    fmt::print("  {:<34} {:>8}\n", "GPU ms", "p50");
    for (const StageSamples::Stage& stage : result.stages.stages())
        fmt::print("    {:<32} {:8.3f}\n", stage.name, percentile(stage.ms, 0.5));
}
