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
                       const CausticsStage::Input in{.points = points_->gpu->points,
                                                     .radiance = radiance,
                                                     .point_count = kWidth * kHeight,
                                                     .camera = cameraParams(camera_, kWidth, kHeight),
                                                     .photon_count = wanted,
                                                     .radius = float(kRadius / diagonalOf(*scene_))};
                       if (time == 0)
                           stage.spread(rec, *map.gpu, in);
                       stage.apply(rec, *map.gpu, in);
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

/// By the tree: the densest node above it that holds a quarter of the photons or more, up to the first that holds all.
TEST_F(Caustics, SpreadEachPhotonAsFarAsTheTreeTells)
{
    const auto map = mapOf(*scene_, photons(2000));
    const double pixel = pixelSide(cameraParams(camera_, kWidth, kHeight)), most2 = kRadius * kRadius;
    const auto disc = [&](const gpu::TreeNode& node, uint32_t wanted)
    {
        const Double3 extent =
            max(Double3(node.left_max), Double3(node.right_max)) - min(Double3(node.left_min), Double3(node.right_min));
        return length2(extent) / 2 / kPi * wanted / node.count;
    };
    for (const uint32_t wanted : {8u, 40u, 200u})
    {
        const auto supports =
            caustics(*mapOf(*scene_, photons(2000)), wanted).supports; // whose tree holds discs from then on
        uint32_t by_tree = 0;
        for (size_t i = 0; i < supports.size(); ++i)
        {
            double want = most2;
            for (uint32_t node = map->tree.leaf_parents[i] & ~gpu::kTreeLeafBit;;
                 node = map->tree.node_parents[node] & ~gpu::kTreeLeafBit)
            {
                if (4 * map->tree.nodes[node].count >= wanted)
                    want = std::min(want, disc(map->tree.nodes[node], wanted));
                if (node == 0 || map->tree.nodes[node].count >= wanted)
                    break;
            }
            const double least2 =
                std::pow(pixel * length(Double3(map->photons[i].position) - Double3(camera_.position)), 2);
            by_tree += want < most2 && want > least2;
            want = std::max(want, std::min(least2, most2));
            ASSERT_NEAR(supports[i], want, 1e-5 * want) << i;
        }
        EXPECT_GT(by_tree, 0u) << wanted;
    }
}

/// About as many discs lie over any point as photons are wanted, where they are even.
TEST_F(Caustics, OfEvenPhotonsHaveAboutTheDiscsAskedFor)
{
    std::vector<gpu::Photon> even;
    Random random(7);
    for (uint32_t i = 0; i < 20000; ++i)
        even.push_back(
            photon({random.between(-1.5f, 1.5f), 0, random.between(-1.5f, 1.5f)}, {0, 1, 0}, {0, -1, 0}, {1, 1, 1}));
    camera_.vertical_fov = 1e-3f; // pixels far smaller than discs
    for (const uint32_t wanted : {40u, 200u})
    {
        double area = 0;
        for (const float support2 : caustics(*mapOf(*scene_, even), wanted).supports)
            area += kPi * support2;
        // A square's cells are squares or halves of them, whose square has 5/4 of their area. The densest of several is chosen,
        // of which the smallest have wanted / 4 photons: with 10, half of their number is 1.6 standard deviations.
        const double over = area / 9;
        fmt::print("  {} discs over a point for {}\n", over, wanted);
        EXPECT_GT(over, 0.5 * wanted);
        EXPECT_LT(over, 1.25 * wanted);
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
