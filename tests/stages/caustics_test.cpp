// Caustics: photons' discs, and their light at every pixel, against brute force over all photons.
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
        camera_ = {.name = "",
                   .position = {0.4f, 1.2f, 2.0f},
                   .forward = forward,
                   .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
                   .vertical_fov = 0.9f,
                   .orthographic_height = 0};
        points_.emplace(device(), *scene_, path, camera_, kWidth, kHeight);
    }

    struct Result
    {
        std::vector<gpu::vec3> radiance; // [kWidth * kHeight]
        std::vector<float> supports;     // of the map's photons
    };
    Result caustics(const PhotonMap& map, uint32_t wanted, gpu::vec3 before = {}, uint32_t times = 1)
    {
        const CausticsStage stage(device(), *scene_, std::max<uint32_t>(uint32_t(map.photons.size()), 1));
        Buffer radiance;
        for (uint32_t time = 0; time < times; ++time)
        {
            radiance = upload("test.radiance", std::vector<gpu::vec3>(kWidth * kHeight, before));
            submit(*scene_,
                   [&](Recorder& rec)
                   {
                       stage.record(rec, *map.gpu,
                                    {.points = points_->gpu->points,
                                     .radiance = radiance,
                                     .point_count = kWidth * kHeight,
                                     .camera = cameraParams(camera_, kWidth, kHeight),
                                     .photon_count = wanted,
                                     .radius = float(kRadius / diagonalOf(*scene_))});
                   });
        }
        return {.radiance = contents<gpu::vec3>(radiance, kWidth * kHeight),
                .supports = contents<float>(stage.supports(), uint32_t(map.photons.size()))};
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
    Camera camera_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<ShadingPoints> points_;
};

/// Its disc holds the k nearest photons of its surface, up to a sixteenth more; never less than to the next pixel.
TEST_F(Caustics, SpreadEachPhotonOverItsNearestOnes)
{
    const auto map = mapOf(*scene_, photons(2000));
    const double pixel = pixelSide(cameraParams(camera_, kWidth, kHeight)), most2 = kRadius * kRadius;
    for (const uint32_t wanted : {8u, 40u, 200u})
    {
        const auto supports = caustics(*map, wanted).supports;
        uint32_t by_count = 0;
        for (size_t i = 0; i < supports.size(); ++i)
        {
            const Double3 x = map->photons[i].position, n = unpackedNormal(map->photons[i].normal);
            const double least2 = std::pow(pixel * length(x - Double3(camera_.position)), 2);
            const double rounding = 1e-5 * supports[i];
            ASSERT_GE(supports[i], std::min(least2, most2) - rounding) << i;
            ASSERT_LE(supports[i], most2 + rounding) << i;
            uint32_t within = 0, nearly = 0;
            for (const gpu::Photon& photon : map->photons)
            {
                const double d2 = surfaceDistance2(Double3(photon.position) - x, n);
                const bool counts =
                    dot(n, unpackedNormal(photon.direction)) < 0 && dot(n, unpackedNormal(photon.normal)) > 0.1;
                within += counts && d2 < supports[i] + rounding;
                nearly += counts && d2 < supports[i] - rounding;
            }
            EXPECT_TRUE(within >= wanted || supports[i] >= most2 - rounding) << i;
            EXPECT_TRUE(nearly <= wanted + wanted / 16 || supports[i] <= least2 + rounding) << i;
            by_count += supports[i] < most2 - rounding && supports[i] > least2 + rounding;
        }
        EXPECT_GT(by_count, 0u) << wanted;
    }
}

TEST_F(Caustics, AreTheLightOfAllDiscsOverEveryPixel)
{
    const auto map = mapOf(*scene_, photons(2000));
    const gpu::vec3 before{1, 2, 3};
    for (const uint32_t times : {1u, 2u}) // the tree that the first one leaves serves the second one as well
    {
        const Result got = caustics(*map, 40, before, times);
        uint32_t lit = 0;
        for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        {
            const ShadingPoints::Point& p = points_->points[pixel];
            Double3 want;
            for (size_t i = 0; isLit(p) && i < map->photons.size(); ++i)
            {
                const gpu::Photon& photon = map->photons[i];
                const Double3 n = unpackedNormal(photon.normal);
                const double d2 = surfaceDistance2(p.position - Double3(photon.position), n),
                             support2 = got.supports[i];
                if (d2 < support2 && dot(p.normal, n) > 0.1 && dot(p.normal, unpackedNormal(photon.direction)) < 0)
                    want = want + 3 / (kPi * support2) * std::pow(1 - d2 / support2, 2) * Double3(photon.power);
            }
            want = p.diffuse.x / kPi * want;
            lit += luminanceOf(want) > 0;
            const Double3 difference = Double3(got.radiance[pixel]) - Double3(before) - want;
            EXPECT_LE(std::sqrt(length2(difference)), 1e-3 * largest(want) + 2e-6) << pixel;
        }
        EXPECT_GT(lit, kWidth * kHeight / 10);
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
    const auto radiance = caustics(*map, 200).radiance;
    uint32_t compared = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        if (!isLit(p) || p.position.y > 1e-3 || std::abs(p.position.x) > 1 || std::abs(p.position.z) > 1)
            continue;
        // A disc of 200 cells of a grid: its edge, where the kernel vanishes, is all that the grid shows in. Discs at the
        // grid's own edge are larger.
        EXPECT_NEAR(radiance[pixel].x, 0.7 * 2 / kPi, 0.01 * 0.7 * 2 / kPi) << pixel;
        ++compared;
    }
    EXPECT_GT(compared, 50u);
}

/// More photons than a search counts to the end, in a spot far smaller than the first guess; pixels are smaller yet.
TEST_F(Caustics, OfADenseFocusAreItsIrradiance)
{
    constexpr int kSide = 120;
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
    const auto map = mapOf(*scene_, grid);
    camera_.vertical_fov = 1e-3f;
    const auto pixels = caustics(*map, 400).radiance;
    const size_t pixel = size_t(floor - points_->points.begin());
    const double want = floor->diffuse.x * floor->throughput.x / kPi; // irradiance 1
    EXPECT_NEAR(pixels[pixel].x, want, 0.01 * want); // as on the even grid above, with twice the photons
}

TEST_F(Caustics, AreDefinedForFewPhotonsAndForEqualOnes)
{
    for (const uint32_t count : {0u, 1u, 7u, 100u})
    {
        const auto map = mapOf(*scene_, std::vector(count, photon({0, 0, 0}, {0, 1, 0}, {0, -1, 0}, {1, 1, 1})));
        const Result got = caustics(*map, 50);
        for (const gpu::vec3& pixel : got.radiance)
            EXPECT_TRUE(std::isfinite(pixel.x));
        EXPECT_TRUE(std::ranges::all_of(got.supports, [](float s) { return s > 0; })) << count;
    }
}
} // namespace
