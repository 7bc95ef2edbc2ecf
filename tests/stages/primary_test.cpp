// Camera rays against the camera's formula in double precision, and how well they are spread over their pixels.
#include "runtime/camera.h"
#include "tests/stages/gpu_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace
{
double dot(gpu::vec3 a, gpu::vec3 b)
{
    return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z;
}
double length(gpu::vec3 a)
{
    return std::sqrt(dot(a, a));
}

struct Point
{
    double x, y;
};

class CameraRays : public GpuTest
{
protected:
    /// By path: the kernel makes them tile by tile.
    static std::vector<gpu::Ray> generate(const gpu::CameraParams& params)
    {
        const uint32_t count = params.width * params.height * params.sample_count;
        const Kernel kernel = device().kernel("primary/generate");
        const Buffer rays = device().array<gpu::Ray>("test.rays", count);
        Recorder rec(device());
        rec.begin();
        rec.run(kernel, count, params, {{"Rays", rays}});
        rec.submitAndWait();
        std::vector<gpu::Ray> made = device().download<gpu::Ray>(rays, count);
        std::ranges::sort(made, {}, &gpu::Ray::path);
        return made;
    }

    /// The first samples of a pixel as points of the unit square, exactly: an orthographic picture of 2 x 2 metres and
    /// one pixel makes positions out of them by operations that single precision does without rounding.
    static std::vector<Point> samplePoints(uint32_t seed, uint32_t first, uint32_t count)
    {
        const gpu::CameraParams params{.position = {0, 0, 0},
                                       .right = {1, 0, 0},
                                       .up = {0, 1, 0},
                                       .forward = {0, 0, -1},
                                       .width = 1,
                                       .height = 1,
                                       .orthographic = 1,
                                       .sample_count = count,
                                       .first_sample = first,
                                       .seed = seed};
        std::vector<Point> points;
        for (const gpu::Ray& ray : generate(params))
            points.push_back({(double(ray.origin.x) + 1) / 2, (1 - double(ray.origin.y)) / 2});
        return points;
    }
};

// ---- The camera's formula ------------------------------------------------------------------------------------------

/// Where on the picture, in pixels from its upper left corner, `camera` sees what lies along `ray`.
Point seenAt(const Camera& camera, const gpu::Ray& ray, uint32_t width, uint32_t height)
{
    const gpu::vec3 right = cross(camera.forward, camera.up);
    const bool orthographic = camera.orthographic_height > 0;
    const gpu::vec3 across = orthographic ? ray.origin + -1.0f * camera.position : ray.direction;
    const double depth = orthographic ? 1 : dot(ray.direction, camera.forward);
    const double half_height = orthographic ? camera.orthographic_height / 2.0 : std::tan(camera.vertical_fov / 2.0);
    const double half_width = half_height * width / height; // square pixels
    return {(dot(across, right) / depth / half_width + 1) / 2 * width,
            (1 - dot(across, camera.up) / depth / half_height) / 2 * height};
}

struct View
{
    const char* name;
    Camera camera;
    uint32_t width, height;
};

/// Looks from `position` along `forward`, its up vector as close to +y as can be.
Camera cameraAt(gpu::vec3 position, gpu::vec3 forward, float vertical_fov, float orthographic_height)
{
    const gpu::vec3 along = normalize(forward), right = normalize(cross(along, {0, 1, 0}));
    return {.name = "",
            .position = position,
            .forward = along,
            .up = cross(right, along),
            .vertical_fov = vertical_fov,
            .orthographic_height = orthographic_height};
}

TEST_F(CameraRays, StartInTheNearPlaneAndEndInTheFarOne)
{
    constexpr float kNear = 3, kFar = 12;
    for (const bool orthographic : {false, true})
    {
        Camera camera = cameraAt({1, 2, 3}, {0.3f, -0.5f, -1}, orthographic ? 0 : 1.2f, orthographic ? 4.0f : 0);
        camera.near_plane = kNear;
        camera.far_plane = kFar;
        gpu::CameraParams params = cameraParams(camera, 32, 16);
        params.sample_count = 2;
        const std::vector<gpu::Ray> rays = generate(params);
        camera.near_plane = camera.far_plane = 0;
        gpu::CameraParams whole_params = cameraParams(camera, 32, 16);
        whole_params.sample_count = 2;
        const std::vector<gpu::Ray> whole = generate(whole_params);
        const auto depth = [&](gpu::vec3 p) { return dot(p + -1.0f * camera.position, camera.forward); };
        constexpr float kTolerance = 1e-5f; // some roundings of numbers up to 24
        for (size_t i = 0; i < rays.size(); ++i)
        {
            ASSERT_NEAR(depth(rays[i].origin), kNear, kTolerance) << orthographic << " " << i;
            ASSERT_NEAR(depth(rays[i].origin + rays[i].t_max * rays[i].direction), kFar, kTolerance) << i;
            // Another piece of the same line.
            const gpu::vec3 way = rays[i].origin + -1.0f * whole[i].origin;
            ASSERT_NEAR(length(cross(way, whole[i].direction)), 0, kTolerance) << i;
            ASSERT_NEAR(length(cross(rays[i].direction, whole[i].direction)), 0, kTolerance) << i;
            ASSERT_GE(whole[i].t_max, 1e30f);
        }
    }
}

class Views : public CameraRays, public testing::WithParamInterface<View>
{
};

TEST_P(Views, SendRaysThroughTheirPixels)
{
    const View& view = GetParam();
    constexpr uint32_t kSamples = 16, kFirst = 5, kSeed = 3;
    gpu::CameraParams params = cameraParams(view.camera, view.width, view.height);
    params.sample_count = kSamples;
    params.first_sample = kFirst;
    params.seed = kSeed;
    const std::vector<gpu::Ray> rays = generate(params);
    const uint32_t pixel_count = view.width * view.height;
    // The same pixels of another camera: how a pixel is sampled is no matter of the camera's.
    gpu::CameraParams plain{.right = {1, 0, 0},
                            .up = {0, 1, 0},
                            .forward = {0, 0, -1},
                            .width = view.width,
                            .height = view.height,
                            .orthographic = 1,
                            .sample_count = kSamples,
                            .first_sample = kFirst,
                            .seed = kSeed};
    const std::vector<gpu::Ray> plain_rays = generate(plain);

    constexpr double kTolerance = 2e-6; // of the picture's size: some roundings of directions and positions
    Point mean{0, 0};
    for (uint32_t path = 0; path < rays.size(); ++path)
    {
        const gpu::Ray& ray = rays[path];
        const uint32_t x = path % pixel_count % view.width, y = path % pixel_count / view.width;
        ASSERT_EQ(ray.path, path);
        ASSERT_GE(ray.t_max, 1e30f);
        ASSERT_NEAR(length(ray.direction), 1, 1e-6);
        const Point at = seenAt(view.camera, ray, view.width, view.height);
        const double tolerance_x = kTolerance * view.width, tolerance_y = kTolerance * view.height;
        ASSERT_GE(at.x, x - tolerance_x) << path;
        ASSERT_LE(at.x, x + 1 + tolerance_x) << path;
        ASSERT_GE(at.y, y - tolerance_y) << path;
        ASSERT_LE(at.y, y + 1 + tolerance_y) << path;
        ASSERT_NEAR(at.x, (double(plain_rays[path].origin.x) + 1) / 2 * view.width, 2 * tolerance_x);
        ASSERT_NEAR(at.y, (1 - double(plain_rays[path].origin.y)) / 2 * view.height, 2 * tolerance_y);
        mean.x += (at.x - x) / double(rays.size());
        mean.y += (at.y - y) / double(rays.size());
        if (view.camera.orthographic_height > 0)
        {
            ASSERT_EQ(ray.direction.x, view.camera.forward.x);
            ASSERT_EQ(ray.direction.y, view.camera.forward.y);
            ASSERT_EQ(ray.direction.z, view.camera.forward.z);
        }
        else
        {
            ASSERT_EQ(ray.origin.x, view.camera.position.x);
            ASSERT_EQ(ray.origin.y, view.camera.position.y);
            ASSERT_EQ(ray.origin.z, view.camera.position.z);
        }
    }
    const double deviation = 1 / std::sqrt(12.0 * double(rays.size())); // of the mean of independent uniform numbers
    EXPECT_NEAR(mean.x, 0.5, 5 * deviation);
    EXPECT_NEAR(mean.y, 0.5, 5 * deviation);
}

INSTANTIATE_TEST_SUITE_P(, Views,
                         testing::Values(View{"Wide", cameraAt({1, 2, 3}, {0.3f, -0.5f, -1}, 1.2f, 0), 64, 20},
                                         View{"Tall", cameraAt({-5, 0, 2}, {1, 0.2f, 0.1f}, 0.5f, 0), 17, 64},
                                         View{"NearlyHemispherical", cameraAt({0, 0, 0}, {0, 0, 1}, 3.0f, 0), 32, 32},
                                         View{"Orthographic", cameraAt({0.5f, 0.25f, 1}, {0.3f, -0.5f, -1}, 0, 3), 40,
                                              30}),
                         [](const auto& view) { return view.param.name; });

// ---- Stratification ------------------------------------------------------------------------------------------------

/// Whether 2^k points lie one each in all boxes of 2^-i x 2^(i-k), for every i.
void expectOneInEveryElementaryInterval(std::span<const Point> points)
{
    const uint32_t k = uint32_t(std::countr_zero(points.size()));
    for (uint32_t i = 0; i <= k; ++i)
    {
        std::set<std::pair<uint64_t, uint64_t>> boxes;
        for (const Point& p : points)
            boxes.insert({uint64_t(std::ldexp(p.x, int(i))), uint64_t(std::ldexp(p.y, int(k - i)))});
        ASSERT_EQ(boxes.size(), points.size()) << "2^" << k << " points, boxes of 2^-" << i << " by 2^-" << k - i;
    }
}

TEST_F(CameraRays, FallOneEachIntoEveryElementaryInterval)
{
    constexpr uint32_t kMostBits = 12;
    for (const uint32_t seed : {0u, 1u, 2u, 77u, 0xffffffffu})
    {
        SCOPED_TRACE(seed);
        const std::vector<Point> points = samplePoints(seed, 0, 1u << kMostBits);
        for (const Point& p : points)
            ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1) << p.x << " " << p.y;
        for (uint32_t k = 0; k <= kMostBits; ++k)
            expectOneInEveryElementaryInterval(std::span(points).first(1u << k));
    }
}

TEST_F(CameraRays, StayStratifiedInEveryAlignedBlockOfTheSequence)
{
    constexpr uint32_t kBits = 6, kBlock = 1u << kBits;
    for (const uint32_t block : {1u, 2u, 3u, 100u, 12345u})
        expectOneInEveryElementaryInterval(samplePoints(9, block * kBlock, kBlock));
}

TEST_F(CameraRays, ContinueTheSequenceFromTheFirstSample)
{
    const std::vector<Point> whole = samplePoints(4, 0, 64), later = samplePoints(4, 40, 24);
    for (size_t i = 0; i < later.size(); ++i)
    {
        EXPECT_EQ(later[i].x, whole[40 + i].x) << i;
        EXPECT_EQ(later[i].y, whole[40 + i].y) << i;
    }
}

TEST_F(CameraRays, AreIndependentFromPixelToPixelAndFromSeedToSeed)
{
    // Correlation of the first samples' x over many seeds, with the next seed's and with the sample's own y.
    constexpr uint32_t kSide = 100, kCount = kSide * kSide;
    const gpu::CameraParams params{.right = {1, 0, 0},
                                   .up = {0, 1, 0},
                                   .forward = {0, 0, -1},
                                   .width = kSide,
                                   .height = kSide,
                                   .orthographic = 1,
                                   .sample_count = 1,
                                   .first_sample = 0,
                                   .seed = 1};
    gpu::CameraParams reseeded = params;
    reseeded.seed = 2;
    const auto within = [](const std::vector<gpu::Ray>& rays)
    {
        std::vector<Point> points;
        for (uint32_t i = 0; i < kCount; ++i)
            points.push_back({(double(rays[i].origin.x) + 1) / 2 * kSide - i % kSide - 0.5,
                              (1 - double(rays[i].origin.y)) / 2 * kSide - i / kSide - 0.5});
        return points;
    };
    const std::vector<Point> points = within(generate(params)), others = within(generate(reseeded));
    std::array<double, 4>
        products{}; // with the right neighbour's x, the lower neighbour's x, the other seed's x, its own y
    for (uint32_t i = 0; i < kCount; ++i)
    {
        const std::array<double, 4> partner{points[(i + 1) % kCount].x, points[(i + kSide) % kCount].x, others[i].x,
                                            points[i].y};
        for (size_t k = 0; k < 4; ++k)
            products[k] += 12 * points[i].x * partner[k] / kCount; // a correlation coefficient: variances are 1/12
    }
    for (const double correlation : products)
        EXPECT_NEAR(correlation, 0, 5 / std::sqrt(double(kCount)));
}
} // namespace
