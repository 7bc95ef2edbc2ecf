// The filter over noisy light against its formula, and what it must leave alone: even light, edges, other surfaces.
#include "runtime/stages/denoise.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <algorithm>
#include <limits>
#include <numbers>

namespace
{
constexpr uint32_t kWidth = 64, kHeight = 48, kPixels = kWidth * kHeight;
constexpr double kHalf = 0x1p-11, kChroma = 0.5 / 4095;               // rounding of what lies in a signal
constexpr double kAllWeights = 1 + 4 / std::numbers::sqrt2 + 4 * 0.5; // of nine pixels of an even wall

class Denoise : public GiTest
{
protected:
    /// A picture of the scene built so far.
    void see(const Camera& camera)
    {
        const auto path = builder_.compile();
        scene_ = load(path);
        camera_ = camera;
        points_.emplace(device(), *scene_, path, camera, kWidth, kHeight);
        pixel_angle_ = camera.vertical_fov > 0 ? 2 * std::tan(camera.vertical_fov / 2) / kHeight : 0;
    }

    /// A wall of albedo 1/2 that fills the picture, one pixel a unit of length.
    void seeWall()
    {
        builder_.quad({-100, -100, 0}, {200, 0, 0}, {0, 200, 0}, builder_.material(lambert(0.5)));
        see({.name = "",
             .position = {0, 0, 5},
             .forward = {0, 0, -1},
             .up = {0, 1, 0},
             .vertical_fov = 0,
             .orthographic_height = kHeight});
    }

    std::vector<gpu::vec3> filtered(const std::vector<gpu::vec3>& light, uint32_t passes)
    {
        const Buffer input = upload("test.light", light);
        const LightBuffers buffers(device(), kPixels, true);
        SignalsStage signals(device(), *scene_, kPixels);
        const DenoiseStage stage(device(), kPixels);
        const FrameInfo frame{.camera = cameraParams(camera_, kWidth, kHeight)};
        submit(*scene_,
               [&](Recorder& rec)
               {
                   buffers.clear(rec, gpu::kLightDirect | gpu::kLightGlossy);
                   rec.copy(input, buffers.direct, kPixels * sizeof(gpu::vec3));
                   const SignalBuffers made = signals.record(rec, frame, *points_->gpu, buffers, gpu::kLightDirect);
                   const Buffer& filtered = stage.record(rec, {.signal = made.direct,
                                                               .guides = made.guides,
                                                               .width = kWidth,
                                                               .height = kHeight,
                                                               .passes = passes,
                                                               .pixel_angle = float(pixel_angle_)});
                   rec.clear(buffers.direct); // where nothing reflects, nothing is written
                   signals.apply(rec, made.direct, filtered, buffers.direct, kPixels);
               });
        return contents<gpu::vec3>(buffers.direct, kPixels);
    }

    Double3 reflectanceAt(uint32_t pixel) const
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        return {p.throughput.x * p.diffuse.x, p.throughput.y * p.diffuse.y, p.throughput.z * p.diffuse.z};
    }

    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
    Camera camera_;
    std::optional<ShadingPoints> points_;
    double pixel_angle_ = 0; // radians
};

class DenoiseOfObjects : public Denoise
{
protected:
    /// Three passes give back the light they got, but for rounding: that of four signals.
    void expectUnchanged(const std::vector<gpu::vec3>& light)
    {
        const auto got = filtered(light, 3);
        for (uint32_t i = 0; i < kPixels; ++i)
        {
            const Double3 want = light[i], ours = got[i];
            EXPECT_LE(largest(max(ours - want, want - ours)), 4 * (kChroma * 3 + kHalf) * (want.x + want.y + want.z))
                << i;
        }
    }

    void SetUp() override
    {
        GiTest::SetUp();
        const nlohmann::json colored =
            with(lambert(1), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.5, 0.2, 1}}}}});
        builder_.floor(3, 0, builder_.material(colored));
        builder_.sphere({-0.4f, 0.4f, 0}, 0.4f, 16, true, builder_.material(lambert(0.6)));
        builder_.box({0.3f, 0, -0.8f}, {0.9f, 0.7f, -0.2f}, builder_.material(lambert(0.3)));
        const gpu::vec3 forward = normalize({-0.15f, -0.35f, -1});
        see({.name = "",
             .position = {0.4f, 1.2f, 2.4f},
             .forward = forward,
             .up = normalize(cross(cross(forward, {0, 1, 0}), forward)),
             .vertical_fov = 0.9f,
             .orthographic_height = 0});
    }
};

/// A pixel as the filter reads it, in double precision.
struct Seen
{
    Double3 light, reflectance, normal;
    double error = 0;
    double brightness() const { return luminanceOf(light) / luminanceOf(reflectance); }
};

/// The normal as 2 x 8 bits hold it. @param margin lowered to how near it was to being rounded otherwise, in steps
Double3 rounded(Double3 n, double& margin)
{
    std::array<double, 2> at = unitToOctahedral(n);
    for (double& x : at)
    {
        margin = std::min(margin, 0.5 - std::abs(x * 127 - std::round(x * 127)));
        x = std::round(x * 127) / 127;
    }
    return octahedralToUnit(at[0], at[1]);
}

/// What the center gets of another pixel's light at a weight of 1: as much as the other one loses.
Double3 flow(const Seen& center, const Seen& other)
{
    const auto channel = [](double r, double other_r, double l, double other_l)
    { return std::min(r, other_r) * (other_l / other_r - l / r); };
    return {channel(center.reflectance.x, other.reflectance.x, center.light.x, other.light.x),
            channel(center.reflectance.y, other.reflectance.y, center.light.y, other.light.y),
            channel(center.reflectance.z, other.reflectance.z, center.light.z, other.light.z)};
}

TEST_F(DenoiseOfObjects, LetsLightFlowBetweenNinePixelsAPass)
{
    Random random(3);
    std::vector<gpu::vec3> light(kPixels);
    std::vector<Seen> seen(kPixels);
    std::vector<double> margins(kPixels, 1);
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const ShadingPoints::Point& p = points_->points[i];
        const Double3 reflectance = reflectanceAt(i);
        if (p.exists)
            light[i] = {float(reflectance.x * random.unit()), float(reflectance.y * random.unit()),
                        float(reflectance.z * random.unit())};
        seen[i] = {.light = light[i], .reflectance = reflectance, .normal = {}};
        if (p.exists)
            seen[i].normal = rounded(p.normal, margins[i]);
    }
    for (int pass = 0, step = 1; pass < 3; ++pass, step *= 3)
    {
        const std::vector<Seen> from = seen;
        const std::vector<double> from_margins = margins;
        for (int i = 0; i < int(kPixels); ++i)
        {
            if (!points_->points[size_t(i)].exists)
                continue;
            const Seen& center = from[size_t(i)];
            Double3 lit = center.light;
            double left = 1, parts2 = 0, variance = 0, weights = 0, mean = 0, mean2 = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx)
                {
                    const int x = i % int(kWidth) + dx * step, y = i / int(kWidth) + dy * step;
                    if (x < 0 || y < 0 || x >= int(kWidth) || y >= int(kHeight))
                        continue;
                    const size_t k = size_t(y) * kWidth + size_t(x);
                    if (!points_->points[k].exists)
                        continue;
                    const Seen& other = from[k];
                    margins[size_t(i)] = std::min(margins[size_t(i)], from_margins[k]);
                    double weight = 1;
                    if (dx != 0 || dy != 0)
                    {
                        const Double3 d = points_->points[k].position - points_->points[size_t(i)].position;
                        const double off = dot(center.normal + other.normal, d) / (2 * length(d) * 0.15),
                                     bend2 = length2(other.normal - center.normal) +
                                             pixel_angle_ * pixel_angle_ * step * step * (dx * dx + dy * dy);
                        weight =
                            std::exp2(-0.5 * (dx * dx + dy * dy)) * std::exp(-off * off - bend2 / (2 * 0.25 * 0.25));
                        if (pass > 0)
                            weight *= std::exp(-std::abs(other.brightness() - center.brightness()) /
                                               (2 * std::hypot(center.error, other.error)));
                    }
                    weights += weight;
                    mean += weight * other.brightness();
                    mean2 += weight * other.brightness() * other.brightness();
                    if (dx == 0 && dy == 0)
                        continue;
                    const double share = weight / kAllWeights;
                    lit = lit + share * flow(center, other);
                    const double part =
                        share * std::min(1.0, luminanceOf(other.reflectance) / luminanceOf(center.reflectance));
                    left -= part;
                    parts2 += part * part;
                    variance += part * part * other.error * other.error;
                }
            Seen& out = seen[size_t(i)];
            out.light = lit;
            variance += left * left * center.error * center.error;
            if (pass == 0)
                variance = std::max(0.0, mean2 / weights - mean * mean / (weights * weights)) * (parts2 + left * left);
            out.error = std::sqrt(variance);
        }
        const auto got = filtered(light, uint32_t(pass) + 1);
        double worst = 0;
        uint32_t compared = 0;
        for (uint32_t i = 0; i < kPixels; ++i)
        {
            if (!points_->points[i].exists || margins[i] < 1e-4)
                continue;
            const Double3 want = seen[i].light, ours = got[i];
            worst = std::max(worst, largest(max(ours - want, want - ours)) / (want.x + want.y + want.z));
            ++compared;
        }
        // Each pass rounds light anew; weights by brightness pass that on, and their own rounding.
        fmt::print("  {} passes: {} pixels, worst deviation {:.5f}\n", pass + 1, compared, worst);
        EXPECT_GT(compared, kPixels / 3);
        EXPECT_LE(worst, (pass + 2) * 2 * (kChroma * 3 + kHalf));
    }
}

TEST_F(DenoiseOfObjects, LeavesEvenLightEvenWhateverItsColor)
{
    std::vector<gpu::vec3> light(kPixels);
    const Double3 even{3, 2, 0.5};
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const Double3 r = reflectanceAt(i);
        light[i] = {float(r.x * even.x), float(r.y * even.y), float(r.z * even.z)};
    }
    expectUnchanged(light);
}

TEST_F(DenoiseOfObjects, KeepsLightOnItsSurface)
{
    // The floor alone is lit, by noise.
    Random random(5);
    std::vector<gpu::vec3> light(kPixels);
    const auto onFloor = [&](uint32_t i)
    { return points_->points[i].exists && std::abs(points_->points[i].position.y) < 1e-4; };
    for (uint32_t i = 0; i < kPixels; ++i)
        if (onFloor(i) && random.unit() < 0.5f)
            light[i] = {1, 1, 1};
    const auto got = filtered(light, 3);
    uint32_t tops = 0;
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const ShadingPoints::Point& p = points_->points[i];
        if (!p.exists || onFloor(i))
            continue;
        // The box's top faces as the floor does, a metre nearer: what parts them is the way between.
        tops += p.normal.y > 0.999;
        EXPECT_LE(got[i].x, 1e-3) << i << ", normal " << p.normal.x << ' ' << p.normal.y << ' ' << p.normal.z;
    }
    EXPECT_GE(tops, 10u);
}

/// Lamps as bright as exporters make them, close to narrow lobes of metal and to wide ones beside it.
TEST_F(Denoise, StandsBrightLampsOnMetal)
{
    for (const float x : {-0.6f, -0.2f, 0.2f, 0.6f})
        builder_.quad({x - 0.2f, -1, 0}, {0.4f, 0, 0}, {0, 2, 0},
                      builder_.material(x * x < 0.1f
                                            ? nlohmann::json{{"pbrMetallicRoughness", {{"roughnessFactor", 0.2}}}}
                                            : lambert(0.5)));
    for (const double x : {-0.3, 0.4})
        builder_.light({{"type", "point"}, {"intensity", 1e6}}, {{"translation", {x, 0.2, 0.3}}});
    const auto scene = load(builder_.compile());
    const Camera camera{.name = "",
                        .position = {0, 0, 2},
                        .forward = {0, 0, -1},
                        .up = {0, 1, 0},
                        .vertical_fov = 0.8f,
                        .orthographic_height = 0};
    const Picture picture =
        renderGi(*scene, camera, smallSettings(), 1, kWidth, kHeight); // expects every sample to be finite
    EXPECT_GT(std::ranges::max(picture.pixels, {}, &gpu::vec3::x).x, 65504) << "else it would not matter";
}

/// One bad sample is one bad pixel.
TEST_F(Denoise, KeepsWhatIsNotFiniteToItself)
{
    seeWall();
    std::vector<gpu::vec3> light(kPixels, {1, 1, 1});
    constexpr uint32_t kBad = kWidth * kHeight / 2 + kWidth / 2;
    light[kBad].y = std::numeric_limits<float>::infinity();
    light[kBad + 1].y = std::numeric_limits<float>::quiet_NaN();
    const auto got = filtered(light, 3);
    for (uint32_t i = 0; i < kPixels; ++i)
        if (i != kBad && i != kBad + 1)
        {
            EXPECT_NEAR(got[i].y, 1, 4 * 3 * (kChroma * 3 + kHalf)) << i;
        }
}

/// As behind glass that lets next to nothing through.
TEST_F(Denoise, AddsNoLightWhereNextToNothingIsReflected)
{
    builder_.quad({-100, -100, 0}, {100, 0, 0}, {0, 200, 0}, builder_.material(lambert(0.5)));
    builder_.quad({0, -100, 0}, {100, 0, 0}, {0, 200, 0}, builder_.material(lambert(1e-7)));
    see({.name = "",
         .position = {0, 0, 5},
         .forward = {0, 0, -1},
         .up = {0, 1, 0},
         .vertical_fov = 0,
         .orthographic_height = kHeight});
    Random random(13);
    std::vector<gpu::vec3> light(kPixels);
    for (uint32_t i = 0; i < kPixels; ++i)
        light[i].x = light[i].y = light[i].z = float(reflectanceAt(i).x) * 2 * random.unit();
    const auto got = filtered(light, 3);
    for (uint32_t i = 0; i < kPixels; ++i)
        if (i % kWidth > kWidth / 2)
        {
            EXPECT_LE(got[i].x, 2 * 1e-4) << i; // what the least reflectance shows of light as bright as next to it
        }
}

TEST_F(Denoise, AveragesNoiseAsMuchAsItsWeightsSay)
{
    seeWall();
    Random random(7);
    std::vector<gpu::vec3> light(kPixels);
    double mean_before = 0;
    for (gpu::vec3& l : light)
    {
        l.x = l.y = l.z = random.unit();
        mean_before += l.x / kPixels;
    }
    const auto got = filtered(light, 1);
    double sum = 0, squares = 0;
    uint32_t count = 0;
    for (uint32_t y = 1; y + 1 < kHeight; ++y)
        for (uint32_t x = 1; x + 1 < kWidth; ++x, ++count)
            sum += got[y * kWidth + x].x, squares += double(got[y * kWidth + x].x) * got[y * kWidth + x].x;
    const double mean = sum / count, variance = squares / count - mean * mean;
    const double gain = (1 + 4 * 0.5 + 4 * 0.25) / (kAllWeights * kAllWeights);
    // Neighbours share pixels: the variance is as accurate as from a ninth as many independent values.
    EXPECT_NEAR(variance, gain / 12, 4 * std::sqrt(2.0 * 9 / count) * gain / 12);
    EXPECT_NEAR(mean, mean_before, 4 * std::sqrt(1.0 / 12 / kPixels));
}

/// As shadow rays make them that rarely reach a strong light: a mean without them would be dark.
TEST_F(DenoiseOfObjects, KeepsTheEnergyOfRareBrightSamples)
{
    Random random(11);
    std::vector<gpu::vec3> light(kPixels);
    Double3 before, after;
    for (uint32_t i = 0; i < kPixels; ++i)
        if (points_->points[i].exists)
        {
            const Double3 r = reflectanceAt(i);
            const double shine = random.unit() < 0.02f ? 50 : 0.1 * random.unit();
            light[i] = {float(r.x * shine), float(r.y * shine), float(r.z * shine)};
            before = before + Double3(light[i]);
        }
    for (const gpu::vec3& l : filtered(light, 5))
        after = after + Double3(l);
    // Each of six signals rounds; pixels round independently, but brightest ones count most: as if all rounded alike.
    const double rounding = 6 * (kChroma * 3 + kHalf);
    EXPECT_NEAR(after.x, before.x, rounding * before.x);
    EXPECT_NEAR(after.y, before.y, rounding * before.y);
    EXPECT_NEAR(after.z, before.z, rounding * before.z);
}

TEST_F(Denoise, LeavesShadowsWithoutNoiseSharp)
{
    seeWall();
    std::vector<gpu::vec3> light(kPixels);
    for (uint32_t i = 0; i < kPixels; ++i)
        if (i % kWidth >= kWidth / 2)
            light[i] = {2, 2, 2};
    const auto got = filtered(light, 3);
    // The first pass has no noise estimate yet and treats the pixels at the edge as noisy. Otherwise a pixel three off
    // the edge would get two fifths of the other side's light, as from a square of 27 pixels.
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const uint32_t x = i % kWidth, from_edge = x < kWidth / 2 ? kWidth / 2 - 1 - x : x - kWidth / 2;
        const double crossed = std::abs(double(got[i].x) - light[i].x) / 2;
        EXPECT_LE(crossed, from_edge == 0 ? 0.3 : from_edge < 13 ? 0.1 : 2 * kHalf) << x;
    }
}
} // namespace
