#include "tools/bench/rays.h"

#include "runtime/stages/rays.h"
#include "shaders/bench/bench.h"

namespace
{
constexpr std::array kKinds{"primary", "diffuse", "diffuse any-hit"};
static_assert(kKinds.size() == RayThroughput::kKindCount);
} // namespace

Result<RayThroughput> measureRays(const Device& device, const SceneGpu& scene, const Camera& camera, uint32_t width,
                                  uint32_t height, uint32_t repeats)
{
    const uint32_t count = width * height;
    const RayStage stage(device, scene);
    const Kernel generate = device.kernel("primary/generate"), diffuse = device.kernel("bench/diffuse");
    const RayQueue primary(device, "bench.primary", count), bounced(device, "bench.bounced", count);
    const Buffer shadow_rays = device.texelArray<gpu::ShadowRay>("bench.shadow_rays", count);
    const Buffer hits = device.array<gpu::Hit>("bench.hits", count),
                 bounced_hits = device.array<gpu::Hit>("bench.bounced_hits", count);
    const Buffer radiance = device.array<gpu::vec3>("bench.radiance", count);

    RayThroughput result;
    constexpr uint32_t kWarmUp = 2;
    for (uint32_t repeat = 0; repeat < kWarmUp + repeats; ++repeat)
    {
        Recorder rec(device);
        rec.timeScopes(true);
        rec.begin(scene.descriptorSet());
        gpu::CameraParams view = cameraParams(camera, width, height);
        view.seed = repeat;
        stage.resize(rec, primary.size, count);
        rec.run(generate, count, view, {{"Rays", primary.rays}});
        rec.clear(radiance);
        rec.clear(bounced.size);
        {
            const auto scope = rec.scope(kKinds[0]);
            stage.closest(rec, primary, hits, repeat);
        }
        rec.run(diffuse, count, gpu::DiffuseParams{.seed = repeat},
                {{"Queue", primary.size},
                 {"Rays", primary.rays},
                 {"Hits", hits},
                 {"NextQueue", bounced.size},
                 {"NextRays", bounced.rays},
                 {"ShadowRays", shadow_rays}});
        stage.close(rec, bounced.size);
        {
            const auto scope = rec.scope(kKinds[1]);
            stage.closest(rec, bounced, bounced_hits, repeat);
        }
        {
            const auto scope = rec.scope(kKinds[2]);
            stage.visible(rec, bounced.size, shadow_rays, radiance);
        }
        const std::vector<StageTime> times = rec.submitAndWait();
        for (size_t kind = 0; repeat >= kWarmUp && kind < kKinds.size(); ++kind)
            result.ms[kind].push_back(times[kind].ms);
    }
    const uint32_t bounced_count = device.download<gpu::QueueSize>(bounced.size, 1)[0].count;
    if (bounced_count == 0)
        return Error{ExitCode::kInvalid,
                     "the camera sees no surface, so there is nothing to measure; choose another with --camera"};
    result.rays = {count, bounced_count, bounced_count};
    return result;
}

namespace
{
void print(const RayThroughput& result, const Device& device, const package::Package& package, bool json)
{
    const uint64_t triangles = package.triangles().size();
    if (json)
    {
        fmt::print("{{\"schema\": \"lumicut-bench-rays/1\", \"device\": \"{}\", \"triangles\": {}", device.name(),
                   triangles);
        constexpr std::array kKeys{"primary", "diffuse", "diffuse_any_hit"};
        for (size_t kind = 0; kind < kKinds.size(); ++kind)
            fmt::print(", \"{}_mrays_per_s\": {:.3f}", kKeys[kind],
                       result.megaraysPerSecond(RayThroughput::Kind(kind)));
        fmt::print("}}\n");
        return;
    }
    fmt::print("{}, {} triangles, {} BVH nodes\n", device.name(), triangles, package.bvhNodes().size());
    for (size_t kind = 0; kind < kKinds.size(); ++kind)
        fmt::print("  {:<16} {:10.2f} Mrays/s  ({} rays, median {:.3f} ms of {} runs)\n", kKinds[kind],
                   result.megaraysPerSecond(RayThroughput::Kind(kind)), result.rays[kind],
                   percentile(result.ms[kind], 0.5), result.ms[kind].size());
}
} // namespace

Status benchRays(const RayBenchOptions& options)
{
    const auto opened = openPackage(options);
    if (!opened)
        return opened.error();
    const auto result =
        measureRays(*opened->device, *opened->scene, opened->camera, options.width, options.height, options.repeats);
    if (!result)
        return result.error();
    print(*result, *opened->device, opened->package, options.json);
    return Success{};
}
