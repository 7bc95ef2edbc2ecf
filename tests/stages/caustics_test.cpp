// Caustics: density estimation at every pixel against brute force over all photons.
#include "runtime/stages/caustics.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <numbers>

namespace
{
constexpr double kPi = std::numbers::pi;
constexpr uint32_t kWidth = 24, kHeight = 20;
constexpr double kRadius = 0.4;

class Caustics : public GiTest
{
protected:
    void SetUp() override
    {
        GiTest::SetUp();
        builder_.floor(3, 0, builder_.material(lambert(0.7)));
        builder_.quad({-1.5f, 0, -1}, {3, 0, 0}, {0, 2, 0}, builder_.material(lambert(0.5)));
        builder_.box({0.3f, 0, -0.4f}, {0.7f, 0.5f, 0}, builder_.material(lambert(0)));
        const auto path = builder_.compile();
        scene_ = load(path);
        const gpu::vec3 forward = normalize({-0.15f, -0.5f, -1});
        points_.emplace(device(), *scene_, path,
                        Camera{.name = "",
                               .position = {0.4f, 1.2f, 2.0f},
                               .forward = forward,
                               .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                               .vertical_fov = 0.9f,
                               .orthographic_height = 0},
                        kWidth, kHeight);
    }

    std::vector<gpu::vec3> caustics(const PhotonMap& map, uint32_t wanted, gpu::vec3 before = {})
    {
        const Buffer radiance = upload("test.radiance", std::vector<gpu::vec3>(kWidth * kHeight, before));
        const CausticsStage stage(device(), *scene_);
        submit(*scene_,
               [&](Recorder& rec)
               {
                   stage.record(rec, *map.gpu,
                                {.points = points_->gpu->points,
                                 .radiance = radiance,
                                 .point_count = kWidth * kHeight,
                                 .photon_count = wanted,
                                 .radius = float(kRadius / diagonalOf(*scene_))});
               });
        return contents<gpu::vec3>(radiance, kWidth * kHeight);
    }

    static gpu::Photon photon(gpu::vec3 position, Double3 normal, Double3 direction, gpu::vec3 power)
    {
        return {
            .position = position, .direction = packedNormal(direction), .power = power, .normal = packedNormal(normal)};
    }

    /// Photons on floor and wall, denser in the middle; a third of them on the far side of their surface.
    static std::vector<gpu::Photon> photons(uint32_t count)
    {
        Random random(31);
        std::vector<gpu::Photon> photons;
        for (uint32_t i = 0; i < count; ++i)
        {
            const double side = i % 3 == 0 ? -1 : 1;
            const float x = random.between(-1.2f, 1.2f) * random.unit(),
                        along = random.between(-0.9f, 0.9f) * random.unit();
            const gpu::vec3 power{random.unit(), random.unit(), 0.5f};
            photons.push_back(i % 2 == 0
                                  ? photon({x, 0, along}, {0, side, 0}, normalized({0.3, -side, 0.2}), power)
                                  : photon({x, 1 + along, -1}, {0, 0, side}, normalized({0.3, 0.1, -side}), power));
        }
        return photons;
    }

    bool isLit(const ShadingPoints::Point& p) const { return p.exists && p.diffuse.x > 0; }

    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<ShadingPoints> points_;
};

TEST_F(Caustics, AreTheDensityOfPhotonsAroundEveryPixel)
{
    const auto map = mapOf(*scene_, photons(2000));
    for (const uint32_t wanted : {8u, 40u, 200u})
    {
        const gpu::vec3 before{1, 2, 3};
        const auto radiance = caustics(*map, wanted, before);
        double sum = 0, exact = 0, difference = 0;
        for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        {
            const ShadingPoints::Point& p = points_->points[pixel];
            const Double3 got = Double3(radiance[pixel]) - Double3(before);
            if (!isLit(p))
            {
                EXPECT_EQ(length2(got), 0) << pixel;
                continue;
            }
            const DensityBounds bounds = densityBounds(map->photons, p.position, p.normal, wanted, kRadius);
            const Double3 least = p.diffuse.x / kPi * bounds.least, most = p.diffuse.x / kPi * bounds.most;
            const double slack = 1e-3 * largest(most) + 2e-6; // rounding, and photons at the rim of the normal test
            EXPECT_LE(largest(least - got), slack) << wanted << ", pixel " << pixel;
            EXPECT_LE(largest(got - most), slack) << wanted << ", pixel " << pixel;
            sum += luminanceOf(got);
            exact += p.diffuse.x / kPi * bounds.exact;
            difference += std::abs(luminanceOf(got) - p.diffuse.x / kPi * bounds.exact);
        }
        fmt::print("  k = {}: mean {:+.3f} %, mean difference {:.3f} % from the exact k-th distance\n", wanted,
                   100 * (sum / exact - 1), 100 * difference / exact);
    }
}

TEST_F(Caustics, OfAnEvenGridAreItsIrradiance)
{
    std::vector<gpu::Photon> grid; // 2 W/m^2 on the floor
    constexpr int kSide = 150;
    for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
        {
            const auto at = [](int j) { return 3 * (float(j) + 0.5f) / kSide - 1.5f; };
            const float power = 2 * 9.0f / (kSide * kSide);
            grid.push_back(photon({at(i), 0, at(k)}, {0, 1, 0}, {0, -1, 0}, {power, power, power}));
        }
    const auto map = mapOf(*scene_, grid);
    const auto radiance = caustics(*map, 200);
    uint32_t compared = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        if (!isLit(p) || p.position.y > 1e-3 || std::abs(p.position.x) > 1.3 || std::abs(p.position.z) > 1.3)
            continue;
        // A disc of 200 cells of a grid: its edge, where the kernel vanishes, is all that the grid shows in.
        EXPECT_NEAR(radiance[pixel].x, 0.7 * 2 / kPi, 0.01 * 0.7 * 2 / kPi) << pixel;
        ++compared;
    }
    EXPECT_GT(compared, 50u);
}

/// More photons than software Vulkan has rounds of loops for a thread, in a spot far smaller than the first guess.
TEST_F(Caustics, OfADenseFocusAreItsIrradiance)
{
    constexpr int kSide = 300;
    constexpr float kSpacing = 1e-4f;
    const auto floor = std::ranges::find_if(points_->points, [](const auto& p)
                                            { return p.exists && p.diffuse.x > 0 && std::abs(p.position.y) < 1e-4; });
    ASSERT_NE(floor, points_->points.end());
    std::vector<gpu::Photon> grid;
    for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k)
            grid.push_back(photon({float(floor->position.x) + (float(i) - kSide / 2) * kSpacing, 0,
                                   float(floor->position.z) + (float(k) - kSide / 2) * kSpacing},
                                  {0, 1, 0}, {0, -1, 0}, {kSpacing * kSpacing, 0, 0}));
    const auto pixels = caustics(*mapOf(*scene_, grid), 400);
    const size_t pixel = size_t(floor - points_->points.begin());
    const double want = floor->diffuse.x * floor->throughput.x / kPi; // irradiance 1
    EXPECT_NEAR(pixels[pixel].x, want, 0.01 * want); // as on the even grid above, with twice the photons
}

TEST_F(Caustics, AreDefinedForFewPhotonsAndForEqualOnes)
{
    for (const uint32_t count : {0u, 1u, 7u, 100u})
    {
        const auto map = mapOf(*scene_, std::vector(count, photon({0, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 1, 1})));
        uint32_t lit = 0;
        for (const gpu::vec3& pixel : caustics(*map, 50))
        {
            EXPECT_TRUE(std::isfinite(pixel.x));
            lit += pixel.x > 0;
        }
        EXPECT_EQ(lit > 0, count > 0) << count;
    }
}
} // namespace
