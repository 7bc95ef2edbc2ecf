// Interpolation against its formula over all samples, and what it may never do: invent or lose even light.
#include "runtime/stages/interpolate.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr uint32_t kWidth = 48, kHeight = 40;
constexpr double kAlpha = 0.3;

class Interpolation : public GiTest
{
protected:
    void SetUp() override
    {
        GiTest::SetUp();
        const nlohmann::json colored =
            with(lambert(1), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.5, 0.2, 1}}}}});
        builder_.floor(3, 0, builder_.material(colored));
        builder_.quad({-1.5f, 0, -1.5f}, {2, 0, 0}, {0, 2, 0}, builder_.material(lambert(0.5)));
        builder_.sphere({-0.4f, 0.4f, 0}, 0.4f, 16, true, builder_.material(lambert(0.6)));
        builder_.box({0.3f, 0, -0.8f}, {0.9f, 0.7f, -0.2f}, builder_.material(lambert(0.3)));
        builder_.box({0.6f, 0, 0.3f}, {0.9f, 0.3f, 0.6f}, builder_.material(lambert(0)));
        const auto path = builder_.compile();
        scene_ = load(path);
        const gpu::vec3 forward = normalize({-0.15f, -0.35f, -1});
        points_.emplace(device(), *scene_, path,
                        Camera{.name = "",
                               .position = {0.4f, 1.2f, 2.4f},
                               .forward = forward,
                               .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                               .vertical_fov = 0.9f,
                               .orthographic_height = 0},
                        kWidth, kHeight);
    }

    /// Samples at shading points chosen by chance. @param support metres, of each
    std::vector<gpu::Sample> samples(uint32_t count, float support, const std::function<gpu::vec3()>& irradiance) const
    {
        Random random(23);
        std::vector<gpu::Sample> samples;
        while (samples.size() < count)
        {
            const uint32_t pixel = random.below(kWidth * kHeight);
            const ShadingPoints::Point& p = points_->points[pixel];
            if (p.exists)
                samples.push_back({.position = {float(p.position.x), float(p.position.y), float(p.position.z)},
                                   .normal = packedNormal(p.normal),
                                   .irradiance = irradiance(),
                                   .support = support * random.between(0.5f, 1),
                                   .harmonic_mean_distance = random.between(0.2f, 2),
                                   .pixel = pixel});
        }
        return samples;
    }

    struct Result
    {
        std::vector<gpu::vec3> radiance;
        gpu::InterpolateStatistics statistics;
    };
    /// What the stage adds to `before` everywhere.
    Result interpolated(const std::vector<gpu::Sample>& samples, gpu::vec3 before)
    {
        const uint32_t count = uint32_t(samples.size());
        std::vector<gpu::vec4> spheres;
        for (const gpu::Sample& s : samples)
            spheres.push_back({s.position.x, s.position.y, s.position.z, s.support});
        const Buffer size = sizeBuffer(count), on_gpu = upload("test.samples", samples),
                     supports = upload("test.spheres", spheres);
        const Buffer radiance = upload("test.radiance", std::vector<gpu::vec3>(kWidth * kHeight, before));
        const InterpolateStage stage(device(), std::max(count, 1u), kWidth * kHeight);
        submit(*scene_,
               [&](Recorder& rec)
               {
                   stage.record(
                       rec,
                       stage.sort(rec, {.size = size, .samples = on_gpu, .spheres = supports},
                                  {.points = points_->gpu->points, .point_count = kWidth * kHeight, .width = kWidth}),
                       {.diffuse_points = points_->gpu->diffuse_points,
                        .radiance = radiance,
                        .point_count = kWidth * kHeight,
                        .width = kWidth,
                        .alpha = float(kAlpha * diagonalOf(*scene_))});
               });
        return {contents<gpu::vec3>(radiance, kWidth * kHeight),
                contents<gpu::InterpolateStatistics>(stage.statistics(), 1)[0]};
    }

    bool isLit(const ShadingPoints::Point& p) const { return p.exists && p.diffuse.x > 0; }
    Double3 reflected(const ShadingPoints::Point& p, Double3 e) const
    {
        return {p.throughput.x * p.diffuse.x * e.x / kPi, p.throughput.y * p.diffuse.y * e.y / kPi,
                p.throughput.z * p.diffuse.z * e.z / kPi};
    }

    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<ShadingPoints> points_;
};

TEST_F(Interpolation, LeavesEvenLightEven)
{
    for (const float support : {0.3f, 1.0f, 10.0f})
        for (const uint32_t count : {20u, 200u})
        {
            const auto [radiance, statistics] = interpolated(samples(count, support,
                                                                     [] {
                                                                         return gpu::vec3{3, 2, 1};
                                                                     }),
                                                             {});
            uint32_t dark = 0;
            for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
            {
                const ShadingPoints::Point& p = points_->points[pixel];
                const Double3 got = radiance[pixel], want = isLit(p) ? reflected(p, {3, 2, 1}) : Double3();
                if (isLit(p) && got.x == 0)
                {
                    ++dark;
                    continue;
                }
                EXPECT_LE(largest(max(got - want, want - got)), 1e-4 * largest(want)) << pixel;
            }
            EXPECT_EQ(dark, statistics.unlit) << "and those only, which no sample is within reach of";
            EXPECT_TRUE(count < 200 || dark == 0) << dark;
            fmt::print("  {} samples, support {} m: {} pixels without an accepted sample, {} without any\n", count,
                       support, statistics.fallbacks, statistics.unlit);
        }
}

/// The weight of one sample at x (method.md, 9), and how near it was to being decided otherwise.
double weightOf(const gpu::Sample& s, Double3 x, Double3 n, double& margin)
{
    const Double3 d = x - Double3(s.position), normal = unpackedNormal(s.normal);
    const double reach = 1 - surfaceDistance2(d, normal) / (double(s.support) * s.support),
                 front = dot(d, n + normal) + 0.01 * s.harmonic_mean_distance;
    if (reach > -1e-4)
        margin = std::min(
            {margin, std::abs(reach), std::abs(dot(n, normal) - 0.01), std::abs(front) / s.harmonic_mean_distance});
    if (reach <= 0 || dot(n, normal) <= 0.01 || front < 0)
        return 0;
    return reach * reach *
           std::min(100.0, 1 / std::max(length(d) / s.harmonic_mean_distance + length(n - normal), 1e-6));
}

TEST_F(Interpolation, WeighsSamplesByDistanceAndNormal)
{
    Random random(29);
    const auto all = samples(150, 0.6f, [&] { return gpu::vec3{random.unit(), random.unit(), random.unit()}; });
    const gpu::vec3 before{7, 8, 9};
    const auto [radiance, statistics] = interpolated(all, before);
    uint32_t fallbacks = 0, unlit = 0, compared = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        const Double3 got = Double3(radiance[pixel]) - Double3(before);
        if (!isLit(p))
        {
            EXPECT_EQ(length2(got), 0) << pixel;
            continue;
        }
        Double3 sum;
        double weights = 0, margin = 1, best = 1e30;
        bool in_reach = false;
        const auto eps = [&](const gpu::Sample& s)
        { return kAlpha * length(p.position - Double3(s.position)) + length(p.normal - unpackedNormal(s.normal)); };
        for (const gpu::Sample& s : all)
        {
            const double weight = weightOf(s, p.position, p.normal, margin);
            sum = sum + weight * Double3(s.irradiance);
            weights += weight;
            if (eps(s) < best)
                best = eps(s), in_reach = true;
        }
        const bool falls_back = weights == 0;
        fallbacks += falls_back;
        unlit += falls_back && !in_reach;
        if (margin < 1e-4) // rounding may accept or refuse a sample
            continue;
        ++compared;
        // Weights change by their own size over 1e-4 of normals' encoding; and the sum with `before` has an ulp of
        // 1e-6.
        const auto matches = [&](Double3 e) {
            return largest(max(got - reflected(p, e), reflected(p, e) - got)) <= 1e-3 * largest(reflected(p, e)) + 2e-6;
        };
        if (!falls_back)
            EXPECT_TRUE(matches((1 / weights) * sum)) << pixel;
        else // the best in reach, or a better one that is a little farther
            EXPECT_TRUE((!in_reach && matches({})) ||
                        std::ranges::any_of(all, [&](const gpu::Sample& s)
                                            { return eps(s) < best + 1e-5 && matches(s.irradiance); }))
                << pixel;
    }
    fmt::print("  {} pixels compared, {} without an accepted sample, {} without any\n", compared, fallbacks, unlit);
    EXPECT_EQ(statistics.fallbacks, fallbacks);
    EXPECT_LE(statistics.unlit, unlit);
    EXPECT_GT(fallbacks, unlit); // else the fallback was not tried
    EXPECT_GT(compared, kWidth * kHeight / 2);
}

TEST_F(Interpolation, LeavesDarkWhatNoSampleReaches)
{
    const auto [radiance, statistics] = interpolated({}, {1, 1, 1});
    for (const gpu::vec3& pixel : radiance)
        EXPECT_TRUE(pixel.x == 1 && pixel.y == 1 && pixel.z == 1);
    EXPECT_EQ(statistics.unlit, std::ranges::count_if(points_->points, [&](const auto& p) { return isLit(p); }));
}
} // namespace
