#include "tools/bench/converge.h"

#include "image/read_exr.h"
#include "image/write_image.h"
#include "runtime/renderer.h"
#include "tools/bench/paths.h"
#include "tools/compare/metrics.h"

#include <nlohmann/json.hpp>

#include <chrono>

namespace
{
struct Row
{
    uint32_t frames;
    double seconds = 0; // here and below: sums over the seeds, until they are averaged
    std::array<double, 3> mean_ratio{};
    double relmse = 0, relmse_trimmed = 0;

    void addTo(double factor, double elapsed, const Metrics& metrics)
    {
        seconds += factor * elapsed;
        relmse += factor * metrics.relmse;
        relmse_trimmed += factor * metrics.relmse_trimmed;
        for (size_t channel = 0; channel < 3; ++channel)
            mean_ratio[channel] += factor * metrics.mean_ratio[channel];
    }
};

struct Convergence
{
    std::vector<Row> rows;
    StageSamples stages; // of every frame
    ImageF picture;      // the last one
};

std::vector<Row> emptyRows(uint32_t frames)
{
    std::vector<Row> rows;
    for (uint64_t count = 1; count < frames; count *= 2)
        rows.push_back({.frames = uint32_t(count)});
    rows.push_back({.frames = frames});
    return rows;
}

Convergence measure(const OpenedPackage& opened, const ImageF& reference, const ConvergeBenchOptions& options)
{
    const Device& device = *opened.device;
    const Mode mode = options.mode == "gi" ? Mode::kGi : Mode::kReference;
    Renderer renderer(device, *opened.scene, mode, reference.width, reference.height, options.settings);
    Recorder rec(device);
    rec.timeScopes(options.stages);
    Convergence result{.rows = emptyRows(options.frames), .stages = {}, .picture = {}};
    const auto render = [&](const Camera& camera, uint32_t seed, uint32_t sample_count)
    {
        rec.begin(opened.scene->descriptorSet());
        {
            const auto scope = rec.scope("frame");
            renderer.record(rec, camera, options.settings, seed, sample_count);
        }
        return rec.submitAndWait();
    };
    render(opened.camera, options.seeds, 1); // a driver may finish its kernels only when they first run
    for (uint32_t seed = 0; seed < options.seeds; ++seed)
    {
        renderer.restart();
        for (int32_t frame = -int32_t(options.travel); frame < 0; ++frame)
            render(movedCamera(opened.camera, opened.scene->info(), float(frame)), seed, 1);
        uint32_t done = 0;
        double seconds = 0;
        for (Row& row : result.rows)
        {
            const auto start = std::chrono::steady_clock::now();
            while (done < row.frames)
            {
                const uint32_t count = std::min(renderer.maxBatch(), row.frames - done);
                result.stages.add(render(opened.camera, seed, count));
                done += count;
            }
            seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
            ImageF picture = pictureOf(renderer, device);
            row.addTo(1.0 / options.seeds, seconds, compareImages(reference, picture));
            result.picture = std::move(picture);
        }
    }
    return result;
}

void printJson(const ConvergeBenchOptions& options, const OpenedPackage& opened, const Convergence& result)
{
    nlohmann::ordered_json json{{"schema", "lumicut-bench-converge/1"},
                                {"device", opened.device->name()},
                                {"package", options.package.filename().string()},
                                {"mode", options.mode},
                                {"seeds", options.seeds}};
    for (const Row& row : result.rows)
        json["rows"].push_back({{"frames", row.frames},
                                {"seconds", row.seconds},
                                {"mean_ratio", row.mean_ratio},
                                {"relmse", row.relmse},
                                {"relmse_trimmed", row.relmse_trimmed}});
    for (const StageSamples::Stage& stage : result.stages.stages())
        json["stages"].push_back(
            {{"name", stage.name}, {"p50_ms", percentile(stage.ms, 0.5)}, {"p95_ms", percentile(stage.ms, 0.95)}});
    fmt::print("{}\n", json.dump(2));
}

void print(const ConvergeBenchOptions& options, const Convergence& result)
{
    fmt::print("{:>7} {:>11} {:>8} {:>8} {:>8} {:>12} {:>12}\n", "frames", "seconds", "ratio R", "ratio G", "ratio B",
               "relMSE", "trimmed");
    for (const Row& row : result.rows)
        fmt::print("{:>7} {:>11.4f} {:>8.4f} {:>8.4f} {:>8.4f} {:>12.6g} {:>12.6g}\n", row.frames, row.seconds,
                   row.mean_ratio[0], row.mean_ratio[1], row.mean_ratio[2], row.relmse, row.relmse_trimmed);
    if (options.stages)
        for (const StageSamples::Stage& stage : result.stages.stages())
            fmt::print("stage {:<20} {:12.4f} ms\n", stage.name, percentile(stage.ms, 0.5));
}
} // namespace

Status benchConverge(const ConvergeBenchOptions& options)
{
    auto reference = readExr(options.reference);
    if (!reference)
        return reference.error().about(options.reference.string());
    blackenNonFinite(*reference);
    const auto opened = openPackage(options);
    if (!opened)
        return opened.error();
    if (const Status status = Renderer::checkSize(*opened->device, reference->width, reference->height); !status)
        return status;
    const Convergence result = measure(*opened, *reference, options);
    if (options.json)
        printJson(options, *opened, result);
    else
        print(options, result);
    return options.output.empty() ? Success{} : writeExr(options.output, result.picture);
}
