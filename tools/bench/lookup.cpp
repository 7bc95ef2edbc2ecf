#include "tools/bench/lookup.h"

#include "runtime/renderer.h"
#include "shaders/lib/terms.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace
{
struct ModeResult
{
    CutMode mode;
    std::string_view name;
    std::vector<gpu::Sample> samples; // of the last frame
    double link_ms = 0, gather_ms = 0, cut_ms = 0;
    uint64_t rays = 0; // lookups of a frame; misses among them
    double mean_error = 0, rms_error = 0, ratio = 0; // of irradiance, against kNN

    double nanoseconds() const { return link_ms * 1e6 / double(rays); }
};

/// `seed` by frame: the error is that of all frames together, not of one photon map.
ModeResult measure(const OpenedPackage& opened, const LookupBenchOptions& options, CutMode mode, std::string_view name)
{
    Settings settings = options.settings;
    settings.cut_mode = uint32_t(mode);
    settings.term = gpu::kTermIndirect;
    Renderer renderer(*opened.device, *opened.scene, Mode::kGi, options.width, options.height, settings);
    Recorder rec(*opened.device);
    const auto render = [&](uint32_t seed)
    {
        rec.begin(opened.scene->descriptorSet());
        renderer.restart();
        renderer.record(rec, opened.camera, settings, seed);
        return rec.submitAndWait();
    };
    render(0);
    StageSamples stages;
    ModeResult result{.mode = mode, .name = name, .samples = {}};
    for (uint32_t seed = 0; seed < options.repeats; ++seed)
    {
        stages.add(render(seed));
        const auto samples = renderer.irradianceSamples(*opened.device);
        result.samples.insert(result.samples.end(), samples.begin(), samples.end());
    }
    result.link_ms = stages.median("gather.link");
    result.gather_ms = stages.median("gather");
    result.cut_ms = stages.median("cut");
    RayTally tally(*opened.device);
    renderer.countRays(&tally);
    render(options.repeats - 1);
    for (const RayTally::Entry& rays : tally.entries())
        if (rays.scope == "gather")
            result.rays += rays.ray_count;
    return result;
}

/// Compares the sum of the three channels, sample by sample. @return false where the samples are not the same ones
bool compare(ModeResult& result, const std::vector<gpu::Sample>& truth)
{
    if (result.samples.size() != truth.size())
        return false;
    double difference = 0, squares = 0, sum = 0, truth_sum = 0, truth_squares = 0;
    for (size_t i = 0; i < truth.size(); ++i)
    {
        if (result.samples[i].pixel != truth[i].pixel)
            return false;
        const gpu::vec3 a = result.samples[i].irradiance, b = truth[i].irradiance;
        const double e = double(a.x) + a.y + a.z, t = double(b.x) + b.y + b.z;
        difference += std::abs(e - t);
        squares += (e - t) * (e - t);
        sum += e;
        truth_sum += t;
        truth_squares += t * t;
    }
    result.mean_error = truth_sum > 0 ? difference / truth_sum : 0;
    result.rms_error = truth_squares > 0 ? std::sqrt(squares / truth_squares) : 0;
    result.ratio = truth_sum > 0 ? sum / truth_sum : 1;
    return true;
}

void printJson(const OpenedPackage& opened, const std::vector<ModeResult>& results)
{
    nlohmann::ordered_json json{{"schema", "lumicut-bench-lookup/1"}, {"device", opened.device->name()}};
    for (const ModeResult& result : results)
        json["modes"].push_back({{"cut_mode", result.name},
                                 {"lookups", result.rays},
                                 {"ns_per_lookup", result.nanoseconds()},
                                 {"gather_ms", result.gather_ms},
                                 {"cut_ms", result.cut_ms},
                                 {"mean_error", result.mean_error},
                                 {"rms_error", result.rms_error},
                                 {"mean_ratio", result.ratio}});
    fmt::print("{}\n", json.dump(2));
}

void print(const OpenedPackage& opened, const std::vector<ModeResult>& results)
{
    fmt::print("{}, {} lookups a frame; error of sample irradiance against full kNN\n", opened.device->name(), results[0].rays);
    fmt::print("{:<10} {:>12} {:>10} {:>11} {:>9} {:>12} {:>11} {:>11}\n", "cut.mode", "ns a lookup", "x faster", "gather ms", "cut ms",
               "mean error", "rms error", "mean ratio");
    for (const ModeResult& result : results)
        fmt::print("{:<10} {:>12.3f} {:>10.1f} {:>11.3f} {:>9.3f} {:>10.3f} % {:>9.3f} % {:>11.4f}\n", result.name, result.nanoseconds(),
                   results[0].nanoseconds() / result.nanoseconds(), result.gather_ms, result.cut_ms, 100 * result.mean_error,
                   100 * result.rms_error, result.ratio);
}
} // namespace

Status benchLookup(const LookupBenchOptions& options)
{
    const auto opened = openPackage(options);
    if (!opened)
        return opened.error();
    if (const Status status = Renderer::checkSize(*opened->device, options.width, options.height); !status)
        return status;
    static_assert(kCutModes.front().value == gpu::kCutKnn, "the others are compared with it");
    std::vector<ModeResult> results;
    for (const auto& [name, mode] : kCutModes)
    {
        results.push_back(measure(*opened, options, CutMode(mode), name));
        if (results.back().rays == 0)
            return Error{ExitCode::kInvalid, "no gather ray was traced: the camera sees no diffuse surface; choose another with --camera"};
        if (!compare(results.back(), results.front().samples))
            return Error{ExitCode::kInvalid, fmt::format("cut.mode {} gathered at other samples than knn, so they cannot be compared", name)};
    }
    if (options.json)
        printJson(*opened, results);
    else
        print(*opened, results);
    return Success{};
}
