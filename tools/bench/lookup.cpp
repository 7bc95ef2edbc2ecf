#include "tools/bench/lookup.h"

#include "runtime/renderer.h"
#include "runtime/stages/reference_irradiance.h"
#include "shaders/lib/terms.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

namespace
{
constexpr uint32_t kPlacementSeed = 0x10cc, kTruthSeed = 0x7275;

struct Difference // from other irradiance at the same samples
{
    double mean_error = 0; // sum |E - T| / sum T
    double ratio = 1;      // sum E / sum T
};

struct ModeResult
{
    CutMode mode;
    std::string_view name;
    std::vector<gpu::Sample> samples; // of the last frame: where they are
    std::vector<double> irradiance;   // of each: sum of the channels, mean over the frames
    double nodes = 0;                 // of the cut, mean over the frames
    double lookup_ms = 0, gather_ms = 0, cut_ms = 0;
    uint64_t rays = 0; // lookups of a frame; misses among them
    Difference from_knn, from_truth;

    double nanoseconds() const { return lookup_ms * 1e6 / double(rays); }
};

struct Truth
{
    std::vector<double> irradiance; // as in ModeResult
    double mean_error = 0;          // mean error that the truth's noise alone would cause
    double ratio_error = 0;         // standard error that it causes in ratios
};

/// @return false where the samples are not those of the frames before
bool addFrame(ModeResult& result, const std::vector<gpu::Sample>& samples, double weight)
{
    if (result.samples.empty())
    {
        result.samples = samples;
        result.irradiance.resize(samples.size());
    }
    if (!std::ranges::equal(samples, result.samples, {}, &gpu::Sample::pixel, &gpu::Sample::pixel))
        return false;
    for (size_t i = 0; i < samples.size(); ++i)
    {
        const gpu::vec3 e = samples[i].irradiance;
        result.irradiance[i] += weight * (double(e.x) + e.y + e.z);
    }
    return true;
}

/// Another seed in every frame, for all but where samples are: the error is not that of one photon map.
Result<ModeResult> measure(const OpenedPackage& opened, const LookupBenchOptions& options, CutMode mode,
                           std::string_view name)
{
    Settings settings = options.settings;
    settings.cut_mode = uint32_t(mode);
    settings.term = gpu::kTermIndirect;
    Renderer renderer(*opened.device, *opened.scene, Mode::kGi, options.width, options.height, settings);
    renderer.placeSamplesBy(kPlacementSeed);
    Recorder rec(*opened.device);
    rec.timeScopes(true);
    const auto render = [&](uint32_t seed)
    {
        rec.begin(opened.scene->descriptorSet());
        renderer.restart();
        renderer.record(rec, opened.camera, settings, seed);
        return rec.submitAndWait();
    };
    render(0);
    StageSamples stages;
    ModeResult result{.mode = mode, .name = name, .samples = {}, .irradiance = {}};
    for (uint32_t seed = 0; seed < options.repeats; ++seed)
    {
        stages.add(render(seed));
        if (!addFrame(result, renderer.irradianceSamples(*opened.device), 1.0 / options.repeats))
            return Error{ExitCode::kInvalid,
                         fmt::format("cut.mode {} gathered at other samples from frame to frame", name)};
        if (mode != CutMode::kKnn)
            result.nodes += double(renderer.cutNodeCount(*opened.device)) / options.repeats;
    }
    result.lookup_ms = stages.median("gather.shade");
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

Truth trace(const OpenedPackage& opened, const LookupBenchOptions& options, const std::vector<gpu::Sample>& samples)
{
    const ReferenceIrradiance reference(*opened.device, *opened.scene, uint32_t(samples.size()), options.truth_rays);
    Truth truth;
    double sum = 0, errors = 0, variance = 0;
    for (const auto& estimate : reference.measure(samples, options.settings.reference_depth, kTruthSeed))
    {
        truth.irradiance.push_back(estimate.irradiance[0] + estimate.irradiance[1] + estimate.irradiance[2]);
        sum += truth.irradiance.back();
        errors += estimate.standard_error;
        variance += estimate.standard_error * estimate.standard_error;
    }
    if (sum > 0)
    {
        truth.mean_error = std::sqrt(2 / std::numbers::pi) * errors / sum; // mean |x| of a normal distribution
        truth.ratio_error = std::sqrt(variance) / sum;
    }
    return truth;
}

Difference compare(const std::vector<double>& irradiance, const std::vector<double>& truth)
{
    double difference = 0, sum = 0, truth_sum = 0;
    for (size_t i = 0; i < truth.size(); ++i)
    {
        difference += std::abs(irradiance[i] - truth[i]);
        sum += irradiance[i];
        truth_sum += truth[i];
    }
    return truth_sum > 0 ? Difference{.mean_error = difference / truth_sum, .ratio = sum / truth_sum} : Difference{};
}

nlohmann::ordered_json jsonOf(const Difference& difference)
{
    return {{"mean_error", difference.mean_error}, {"mean_ratio", difference.ratio}};
}

void printJson(const OpenedPackage& opened, const LookupBenchOptions& options, const std::vector<ModeResult>& results,
               const std::optional<Truth>& truth)
{
    nlohmann::ordered_json json{{"schema", "lumicut-bench-lookup/2"},
                                {"device", opened.device->name()},
                                {"samples", results[0].samples.size()},
                                {"repeats", options.repeats}};
    if (truth)
        json["traced"] = {{"rays", options.truth_rays},
                          {"mean_error", truth->mean_error},
                          {"ratio_standard_error", truth->ratio_error}};
    for (const ModeResult& result : results)
    {
        json["modes"].push_back({{"cut_mode", result.name},
                                 {"nodes", result.nodes},
                                 {"lookups", result.rays},
                                 {"ns_per_lookup", result.nanoseconds()},
                                 {"gather_ms", result.gather_ms},
                                 {"cut_ms", result.cut_ms},
                                 {"against_knn", jsonOf(result.from_knn)}});
        if (truth)
            json["modes"].back()["against_traced"] = jsonOf(result.from_truth);
    }
    fmt::print("{}\n", json.dump(2));
}

void print(const OpenedPackage& opened, const LookupBenchOptions& options, const std::vector<ModeResult>& results,
           const std::optional<Truth>& truth)
{
    fmt::print("{}, {} lookups a frame; irradiance of {} samples, mean of {} frames, against full kNN{}\n",
               opened.device->name(), results[0].rays, results[0].samples.size(), options.repeats,
               truth ? " and against path tracing" : "");
    fmt::print("{:<10} {:>9} {:>12} {:>9} {:>10} {:>9} {:>10} {:>9}{}\n", "cut.mode", "nodes", "ns a lookup",
               "x faster", "gather ms", "cut ms", "kNN error", "ratio",
               truth ? fmt::format(" {:>13} {:>9}", "traced error", "ratio") : "");
    const auto figures = [](const Difference& d)
    { return fmt::format("{:>8.3f} % {:>9.4f}", 100 * d.mean_error, d.ratio); };
    for (const ModeResult& result : results)
        fmt::print("{:<10} {:>9.0f} {:>12.3f} {:>9.1f} {:>10.3f} {:>9.3f} {}{}\n", result.name, result.nodes,
                   result.nanoseconds(), results[0].nanoseconds() / result.nanoseconds(), result.gather_ms,
                   result.cut_ms, figures(result.from_knn),
                   truth ? fmt::format("    {}", figures(result.from_truth)) : "");
    if (truth)
        fmt::print(
            "path tracing with {} rays a sample: its noise alone is a mean error of {:.3f} %, and {:.4f} of a ratio\n",
            options.truth_rays, 100 * truth->mean_error, truth->ratio_error);
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
    std::optional<Truth> truth;
    for (const auto& [name, mode] : kCutModes)
    {
        const Result<ModeResult> measured = measure(*opened, options, CutMode(mode), name);
        if (!measured)
            return measured.error();
        ModeResult& result = results.emplace_back(*measured);
        if (result.rays == 0)
            return Error{ExitCode::kInvalid,
                         "no gather ray was traced: the camera sees no diffuse surface; choose another with --camera"};
        if (!std::ranges::equal(result.samples, results[0].samples, {}, &gpu::Sample::pixel, &gpu::Sample::pixel))
            return Error{
                ExitCode::kInvalid,
                fmt::format("cut.mode {} gathered at other samples than knn, so they cannot be compared", name)};
        if (results.size() == 1 && options.truth_rays > 0)
            truth = trace(*opened, options, result.samples);
        result.from_knn = compare(result.irradiance, results[0].irradiance);
        if (truth)
            result.from_truth = compare(result.irradiance, truth->irradiance);
    }
    if (options.json)
        printJson(*opened, options, results, truth);
    else
        print(*opened, options, results, truth);
    return Success{};
}
