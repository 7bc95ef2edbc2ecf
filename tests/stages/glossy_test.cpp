// Rough reflection, by rays and by spherical harmonics: their numbers against formulas, and no seam between them.
#include "runtime/stages/gather.h"
#include "runtime/stages/glossy.h"
#include "runtime/stages/interpolate.h"
#include "shaders/lib/terms.h"
#include "tests/stages/closed_form.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/gltf_brdf.h"
#include "tests/stages/lobe_numbers.h"

#include <array>
#include <cmath>

namespace
{
constexpr double kAlbedo = 0.6; // of the room's walls
constexpr gpu::vec3 kLow{-1, 0, -1.5f}, kHigh{1, 1.5f, 1.5f};

nlohmann::json plastic(double roughness)
{
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}, {"metallicFactor", 0}, {"roughnessFactor", roughness}}}};
}

// ---- The light of a sample by direction -----------------------------------------------------------------------------

/// B_lm of bands 1 to 3, in the order of lib/harmonics.glsl.
std::array<double, 15> basis(Double3 d)
{
    const double x = d.x, y = d.y, z = d.z;
    return {y,
            z,
            x,
            std::sqrt(3) * x * y,
            std::sqrt(3) * y * z,
            (3 * z * z - 1) / 2,
            std::sqrt(3) * x * z,
            std::sqrt(3) / 2 * (x * x - y * y),
            std::sqrt(5.0 / 8) * y * (3 * x * x - y * y),
            std::sqrt(15) * x * y * z,
            std::sqrt(3.0 / 8) * y * (5 * z * z - 1),
            z * (5 * z * z - 3) / 2,
            std::sqrt(3.0 / 8) * x * (5 * z * z - 1),
            std::sqrt(15) / 2 * z * (x * x - y * y),
            std::sqrt(5.0 / 8) * x * (x * x - 3 * y * y)};
}

double coefficient(const gpu::SampleHarmonics& h, size_t channel, size_t k)
{
    return std::max(-1.0, int8_t(h.words[4 * channel + k / 4] >> 8 * (k % 4)) / 127.0);
}

/// Int cos B_k dw / pi about the normal n: 2/3 and 1/4 of bands 1 and 2, nothing of band 3.
double evenCoefficient(Double3 n, size_t k)
{
    return (k < 3 ? 2.0 / 3 : k < 8 ? 0.25 : 0) * basis(n)[k];
}

class Glossy : public GiTest
{
protected:
    static constexpr uint32_t kRays = 256;

    /// A room around everything, the floor of `floor`; wall by wall the light on it.
    static std::filesystem::path room(SceneBuilder& builder, const nlohmann::json& floor)
    {
        builder.box(kLow, kHigh, builder.material(lambert(kAlbedo)), true);
        builder.quad({-0.9f, 0.01f, 1.4f}, {1.8f, 0, 0}, {0, 0, -2.8f}, builder.material(floor));
        return builder.compile();
    }
    using OnWall = std::function<gpu::vec3(Double3)>; // irradiance by the wall's inward normal
    /// A node on each wall, so wide that its light is even over the room, to 1e-6.
    static std::vector<gpu::CutNode> wallNodes(const OnWall& irradiance)
    {
        std::vector<gpu::CutNode> nodes;
        const std::array<float, 3> low{kLow.x, kLow.y, kLow.z}, high{kHigh.x, kHigh.y, kHigh.z};
        for (size_t axis = 0; axis < 3; ++axis)
            for (const bool upper : {false, true})
            {
                std::array<float, 3> at{};
                std::array<double, 3> n{};
                for (size_t i = 0; i < 3; ++i)
                    at[i] = 0.5f * (low[i] + high[i]);
                at[axis] = upper ? high[axis] : low[axis];
                n[axis] = upper ? -1 : 1;
                const Double3 normal(n[0], n[1], n[2]);
                nodes.push_back({.center = {at[0], at[1], at[2]},
                                 .support = 2000,
                                 .irradiance = irradiance(normal),
                                 .normal_and_eye = packedCutNormal(normal)});
            }
        return nodes;
    }

    std::vector<gpu::SampleHarmonics> projected(const SceneGpu& scene, const std::vector<gpu::Sample>& samples,
                                                const OnWall& irradiance)
    {
        const uint32_t count = uint32_t(samples.size());
        const auto cut = cutOf(scene, wallNodes(irradiance));
        const auto map = mapOf(scene, {});
        const Buffer size = sizeBuffer(count), on_gpu = upload("test.samples", samples),
                     spheres = upload("test.spheres", std::vector<gpu::vec4>(count));
        const GatherStage stage(device(), scene, count, kRays, kRays);
        submit(scene,
               [&](Recorder& rec)
               {
                   stage.record(rec, map->rays, {.size = size, .samples = on_gpu, .spheres = spheres}, *map->gpu,
                                *cut->gpu,
                                {.mode = CutMode::kRefined,
                                 .ray_count = kRays,
                                 .specular_depth = 2,
                                 .photon_count = 50,
                                 .radius = 5,
                                 .seed = 3,
                                 .by_direction = true});
               });
        return contents<gpu::SampleHarmonics>(stage.harmonics(), count);
    }

    static std::vector<gpu::Sample> inRoom()
    {
        std::vector<gpu::Sample> samples;
        for (const Double3 n : {Double3(0, 1, 0), Double3(0, -1, 0), normalized(Double3(0.6, 0.5, 0.3)),
                                normalized(Double3(-0.4, 0.2, -0.8))})
            for (const gpu::vec3 x : {gpu::vec3{0.2f, 0.7f, 0.3f}, gpu::vec3{-0.5f, 0.9f, -0.8f}})
                samples.push_back({.position = x,
                                   .normal = packedNormal(n),
                                   .irradiance = {},
                                   .support = 1,
                                   .harmonic_mean_distance = 1,
                                   .pixel = 0});
        return samples;
    }
};

/// The wall that a ray meets, by its inward normal.
Double3 wallSeen(Double3 x, Double3 d)
{
    const double from[]{x.x, x.y, x.z}, along[]{d.x, d.y, d.z}, low[]{kLow.x, kLow.y, kLow.z},
        high[]{kHigh.x, kHigh.y, kHigh.z};
    double nearest = 1e30;
    std::array<double, 3> normal{};
    for (size_t axis = 0; axis < 3; ++axis)
    {
        const bool upper = along[axis] > 0;
        const double t = along[axis] == 0 ? 1e30 : ((upper ? high[axis] : low[axis]) - from[axis]) / along[axis];
        if (t < nearest)
        {
            nearest = t;
            normal = {};
            normal[axis] = upper ? -1 : 1;
        }
    }
    return {normal[0], normal[1], normal[2]};
}

/// 4 standard errors of independent rays (stratified ones do better) and half a step of a byte.
TEST_F(Glossy, GatheringProjectsTheLightByDirection)
{
    SceneBuilder builder;
    const std::filesystem::path path = [&]
    {
        builder.box(kLow, kHigh, builder.material(lambert(kAlbedo)), true);
        builder.quad({50, 50, 50}, {1, 0, 0}, {0, 1, 0},
                     builder.material(plastic(0.5))); // far away: there is rough reflection
        return builder.compile();
    }();
    const auto scene = load(path);
    ASSERT_TRUE(scene->reflectsRoughly());
    const OnWall lights[]{[](Double3) {
                              return gpu::vec3{3, 2, 1};
                          },
                          [](Double3 n) {
                              return gpu::vec3{float(1 + n.x), float(0.05 + (n.y < 0)), float(0.2 + (n.z > 0))};
                          }};
    for (const OnWall& light : lights)
    {
        const bool even = &light == lights;
        const auto samples = inRoom();
        const auto got = projected(*scene, samples, light);
        double largest_share = 0; // of what is allowed
        for (size_t i = 0; i < samples.size(); ++i)
        {
            const Double3 n = unpackedNormal(samples[i].normal), x = samples[i].position;
            const Double3 t = normalized(std::abs(n.x) < 0.5 ? Double3(0, n.z, -n.y) : Double3(n.z, 0, -n.x));
            const Double3 s{n.y * t.z - n.z * t.y, n.z * t.x - n.x * t.z, n.x * t.y - n.y * t.x};
            constexpr int kSteps = 128;
            std::vector<std::pair<std::array<double, 15>, std::array<double, 3>>> rays; // cosine-distributed
            for (int j = 0; j < kSteps * kSteps; ++j)
            {
                const double r2 = (j % kSteps + 0.5) / kSteps, r = std::sqrt(r2),
                             phi = 2 * kPi * (double(j / kSteps) + 0.5) / kSteps;
                const Double3 d = r * std::cos(phi) * t + r * std::sin(phi) * s + std::sqrt(1 - r2) * n;
                const gpu::vec3 l = light(wallSeen(x, d));
                rays.push_back({basis(d), {l.x, l.y, l.z}});
            }
            for (size_t channel = 0; channel < 3; ++channel)
                for (size_t k = 0; k < 15; ++k)
                {
                    double whole = 0, sum = 0, variance = 0;
                    for (const auto& [b, l] : rays)
                        whole += l[channel], sum += l[channel] * b[k];
                    const double want = sum / whole;
                    for (const auto& [b, l] : rays) // of the ratio of two sums
                        variance += std::pow(l[channel] * (b[k] - want), 2);
                    const double deviation =
                        std::sqrt(variance / double(rays.size()) / kRays) / (whole / double(rays.size()));
                    if (even)
                    {
                        EXPECT_NEAR(want, evenCoefficient(n, k), 1e-3);
                    }
                    const double allowed = 4 * deviation + 0.5 / 127 + 1e-4,
                                 difference = std::abs(coefficient(got[i], channel, k) - want);
                    EXPECT_LE(difference, allowed) << "sample " << i << " channel " << channel << " coefficient " << k;
                    largest_share = std::max(largest_share, difference / allowed);
                }
        }
        fmt::print("  {} light: largest difference {:.2f} of what is allowed\n", even ? "even" : "uneven",
                   largest_share);
    }
}

// ---- Reflection by harmonics ----------------------------------------------------------------------------------------

class GlossyView : public Glossy
{
protected:
    static constexpr uint32_t kSide = 8;
    static constexpr gpu::vec3 kPoint{0, 0.01f, 0};
    static Camera cameraAt(double cosine)
    {
        return viewOf(kPoint, {float(std::sqrt(1 - cosine * cosine)), float(cosine), 0}, 0.3f);
    }

    /// What the interpolation makes of one sample's light in view.
    gpu::vec3 reflected(const SceneGpu& scene, double cosine, gpu::vec3 irradiance, const gpu::SampleHarmonics& light)
    {
        PrimaryStage primary(device(), scene, kSide * kSide);
        const RayStage rays(device(), scene);
        gpu::CameraParams view = cameraParams(cameraAt(cosine), kSide, kSide);
        view.sample_count = 1;
        const Buffer emission = upload("test.emission", std::vector<gpu::vec3>(kSide * kSide));
        const Buffer size = sizeBuffer(1), radiance = upload("test.radiance", std::vector<gpu::vec3>(kSide * kSide)),
                     samples = upload<gpu::Sample>("test.samples", {{.position = kPoint,
                                                                     .normal = packedNormal({0, 1, 0}),
                                                                     .irradiance = irradiance,
                                                                     .support = 1,
                                                                     .harmonic_mean_distance = 1,
                                                                     .pixel = 0}}),
                     spheres = upload<gpu::vec4>("test.spheres", {{kPoint.x, kPoint.y, kPoint.z, 1}}),
                     harmonics = device().uploadTexels<gpu::SampleHarmonics>("test.harmonics", std::vector{light});
        const InterpolateStage interpolate(device(), 1, kSide * kSide);
        const GlossyStage stage(device(), scene, kSide * kSide);
        submit(scene,
               [&](Recorder& rec)
               {
                   const auto points =
                       primary.record(rec, rays, {.camera = view, .specular_depth = 1, .emission = emission});
                   const auto sorted = interpolate.sort(
                       rec, {.size = size, .samples = samples, .spheres = spheres},
                       {.points = points.points, .point_count = kSide * kSide, .width = kSide, .by_direction = true});
                   stage.recordHarmonics(rec, sorted, harmonics,
                                         {.points = points.points,
                                          .radiance = radiance,
                                          .point_count = kSide * kSide,
                                          .width = kSide,
                                          .first_sample = 0,
                                          .specular_depth = 0,
                                          .seed = 0});
               });
        const auto pixels = contents<gpu::vec3>(radiance, kSide * kSide);
        return pixels[kSide * kSide / 2];
    }

    static gpu::GlossyLobe lobeAt(double roughness, double cosine) // bilinear
    {
        static const std::vector<gpu::GlossyLobe> kLobes = glossyLobes();
        const double r = (roughness - gpu::kHarmonicsFrom) / (1 - gpu::kHarmonicsFrom) * (gpu::kLobeRoughnesses - 1),
                     c = cosine * (gpu::kLobeCosines - 1);
        const uint32_t i = std::min(uint32_t(r), gpu::kLobeRoughnesses - 2),
                       k = std::min(uint32_t(c), gpu::kLobeCosines - 2);
        gpu::GlossyLobe sum{};
        for (uint32_t corner = 0; corner < 4; ++corner)
        {
            const uint32_t right = corner & 1, up = corner >> 1;
            const float w = float((right ? r - i : 1 - (r - i)) * (up ? c - k : 1 - (c - k)));
            const gpu::GlossyLobe& l = kLobes[(i + right) * gpu::kLobeCosines + k + up];
            sum.height += w * l.height, sum.concentration += w * l.concentration, sum.scale += w * l.scale,
                sum.bias += w * l.bias;
        }
        return sum;
    }
};

gpu::SampleHarmonics packed(const std::function<double(size_t)>& coefficient)
{
    gpu::SampleHarmonics h{};
    for (size_t channel = 0; channel < 3; ++channel)
        for (size_t k = 0; k < 15; ++k)
            h.words[4 * channel + k / 4] |= uint32_t(uint8_t(int8_t(std::lround(127 * coefficient(k))))) << 8 * (k % 4);
    return h;
}

/// Even light of radiance 1. Allowed: half a byte's step in each coefficient, which the lobe's sum may pile up, plus
/// what linear interpolation in the table may be off by, an eighth of the second differences, taken double.
TEST_F(GlossyView, OfEvenLightByHarmonicsIsTheDirectionalReflectance)
{
    const gpu::SampleHarmonics even = packed([](size_t k) { return evenCoefficient({0, 1, 0}, k); });
    for (const double roughness : {0.67, 0.75, 0.9, 1.0})
    {
        SceneBuilder builder;
        const auto scene = load(room(builder, plastic(roughness)));
        for (const double cosine : {0.1, 0.4, 0.75, 1.0})
        {
            const gpu::vec3 got = reflected(*scene, cosine, {float(kPi), float(kPi), float(kPi)}, even);
            const double want = specularAlbedo(roughness, cosine);
            const gpu::GlossyLobe lobe = lobeAt(roughness, cosine);
            const auto at = [](double r, double c)
            { return reflectanceOf(glossyLobe(std::clamp(r, 0.1, 1.0), std::clamp(c, 0.0, 1.0))); };
            const double dr = tableRoughness(1) - tableRoughness(0), dc = tableCosine(1),
                         r = std::min(roughness, 1 - dr), c = std::clamp(cosine, dc, 1 - dc);
            const double bends = std::abs(at(r - dr, c) - 2 * at(r, c) + at(r + dr, c)) +
                                 std::abs(at(r, c - dc) - 2 * at(r, c) + at(r, c + dc));
            const auto zonal = zonalOf(lobe);
            double bytes = 0; // B_lm squared sum to 1 over a band
            for (size_t band = 1; band < 4; ++band)
                bytes += 0.5 / 127 * std::sqrt(2 * double(band) + 1) * std::abs(zonal[band]);
            const double allowed = want * (bytes / evenAnswer(lobe) + 0.005) + 2 * bends / 8;
            fmt::print("  roughness {}, cosine {}: {:.5f}, want {:.5f} +- {:.5f}\n", roughness, cosine, got.x, want,
                       allowed);
            EXPECT_NEAR(got.x, want, allowed);
            EXPECT_EQ(got.x, got.y);
            EXPECT_EQ(got.x, got.z);
        }
    }
}

/// The kernel against the sums of harmonics.h in double precision, over light of any shape.
TEST_F(GlossyView, OfAnyLightIsTheLobesSumOverHarmonics)
{
    std::array<double, 15> h{};
    for (size_t k = 0; k < h.size(); ++k)
        h[k] = std::round(127 * 0.4 * std::sin(1.0 + 2.3 * double(k))) / 127;
    const gpu::SampleHarmonics light = packed([&](size_t k) { return h[k]; });
    for (const double roughness : {0.7, 0.8})
    {
        SceneBuilder builder;
        const auto scene = load(room(builder, plastic(roughness)));
        for (const double cosine : {0.3, 0.7})
        {
            const gpu::vec3 got = reflected(*scene, cosine, {2, 1, 0.5f}, light);
            const gpu::GlossyLobe lobe = lobeAt(roughness, cosine);
            const auto b =
                basis({-std::sqrt(1 - lobe.height * lobe.height), lobe.height, 0}); // the viewer is at +x, up is y
            double sum = 1;
            for (size_t k = 0; k < 15; ++k)
                sum += zonalOf(lobe)[k < 3 ? 1 : k < 8 ? 2 : 3] * h[k] * b[k];
            const double want = reflectanceOf(lobe) * std::max(0.0, sum) / evenAnswer(lobe) / kPi;
            EXPECT_NEAR(got.x, 2 * want, 1e-3 * want + 1e-6) << roughness << ' ' << cosine;
            EXPECT_NEAR(got.z, 0.5 * want, 1e-3 * want + 1e-6) << roughness << ' ' << cosine;
        }
    }
}

/// By rays: a mean over pixels and frames, within 4 standard errors.
TEST_F(GlossyView, OfEvenLightByRaysIsTheDirectionalReflectance)
{
    constexpr uint32_t kPixels = 32 * 32;
    const auto nodes = wallNodes([](Double3) { return gpu::vec3{1, 1, 1}; });
    for (const double roughness : {0.2, 0.4, 0.7})
    {
        SceneBuilder builder;
        const auto scene = load(room(builder, plastic(roughness)));
        const auto cut = cutOf(*scene, nodes);
        for (const double cosine : {0.3, 0.9})
        {
            PrimaryStage primary(device(), *scene, kPixels);
            const RayStage rays(device(), *scene);
            const GlossyStage stage(device(), *scene, kPixels);
            gpu::CameraParams view = cameraParams(cameraAt(cosine), 32, 32);
            view.sample_count = 1;
            double sum = 0, squares = 0;
            constexpr uint32_t kFrames = 16;
            for (uint32_t frame = 0; frame < kFrames; ++frame)
            {
                const Buffer radiance = upload("test.radiance", std::vector<gpu::vec3>(kPixels)),
                             emission = upload("test.emission", std::vector<gpu::vec3>(kPixels));
                submit(*scene,
                       [&](Recorder& rec)
                       {
                           const auto points =
                               primary.record(rec, rays, {.camera = view, .specular_depth = 1, .emission = emission});
                           stage.record(rec, rays, *cut->gpu,
                                        {.points = points.points,
                                         .radiance = radiance,
                                         .point_count = kPixels,
                                         .width = 32,
                                         .first_sample = frame,
                                         .specular_depth = 1,
                                         .seed = 1});
                       });
                for (const gpu::vec3& pixel : contents<gpu::vec3>(radiance, kPixels))
                    sum += pixel.x, squares += double(pixel.x) * pixel.x;
            }
            const double n = double(kPixels) * kFrames, mean = sum / n,
                         error = std::sqrt((squares / n - mean * mean) / n);
            const double want = kAlbedo / kPi * specularAlbedo(roughness, cosine);
            fmt::print("  roughness {}, cosine {}: {:.5f} +- {:.5f}, want {:.5f}\n", roughness, cosine, mean, error,
                       want);
            EXPECT_NEAR(mean, want, 4 * error + 1e-3 * want);
        }
    }
}

// ---- The frame ------------------------------------------------------------------------------------------------------

class GlossyRamp : public Glossy
{
protected:
    static constexpr uint32_t kStrips = 21, kStripPixels = 6, kWidth = kStrips * kStripPixels, kHeight = 24;

    /// A floor of strips of roughness 0.05 to 1 in a lit room; the first is a smooth mirror and has no glossy light.
    static std::filesystem::path strips(SceneBuilder& builder)
    {
        builder.box({-1.05f, -0.01f, -1}, {1.05f, 1.5f, 1}, builder.material(lambert(kAlbedo)), true);
        builder.quad({-0.5f, 1.49f, -0.3f}, {1, 0, 0}, {0, 0, 0.6f}, builder.material(emitter(10)));
        for (uint32_t i = 0; i < kStrips; ++i)
            builder.quad(
                {-1.05f + 0.1f * float(i), 0, 0.5f}, {0.1f, 0, 0}, {0, 0, -1},
                builder.material(with(plastic(0.05 * i), {{"extensions", {{"KHR_materials_ior", {{"ior", 2.5}}}}}})));
        return builder.compile();
    }
    /// Parallel rays at 45 degrees onto the strips, as wide as they are.
    static Camera camera() { return viewOf({0, 0, 0}, {0, 1, 1}, 1, 2.1f * kHeight / kWidth); }
    static Settings settings(GlossyMode mode)
    {
        Settings settings;
        settings.photon_count = 20000;
        settings.sample_count = 512;
        settings.gather_rays = 64;
        settings.glossy_mode = uint32_t(mode);
        settings.term = gpu::kTermGlossy;
        return settings;
    }
    static std::vector<double> strip(const Picture& picture) // means
    {
        std::vector<double> means(kStrips);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                means[x / kStripPixels] += picture.pixels[y * kWidth + x].y / double(kHeight * kStripPixels);
        return means;
    }
};

TEST_F(GlossyRamp, HasNoSeamWhereHarmonicsTakeOver)
{
    SceneBuilder builder;
    const auto scene = load(strips(builder));
    constexpr uint32_t kSeeds = 12;
    const auto rendered = [&](GlossyMode mode)
    {
        std::vector<double> sums(kStrips), squares(kStrips);
        for (uint32_t seed = 0; seed < kSeeds; ++seed)
        {
            const auto means = strip(renderGi(*scene, camera(), settings(mode), 1, kWidth, kHeight, seed));
            for (size_t i = 0; i < kStrips; ++i)
                sums[i] += means[i] / kSeeds, squares[i] += means[i] * means[i] / kSeeds;
        }
        std::vector<std::pair<double, double>> result; // mean, standard error
        for (size_t i = 0; i < kStrips; ++i)
            result.emplace_back(sums[i], std::sqrt(std::max(0.0, squares[i] - sums[i] * sums[i]) / (kSeeds - 1)));
        return result;
    };
    const auto harmonics = rendered(GlossyMode::kHarmonics), rays = rendered(GlossyMode::kRays);
    const auto truth =
        strip(render(*scene, camera(), settings(GlossyMode::kRays), 256, kWidth, kHeight, Mode::kReference));
    for (size_t i = 0; i < kStrips; ++i)
        fmt::print("  roughness {:.2f}: harmonics {:.5f} +- {:.5f}, rays {:.5f} +- {:.5f}, reference {:.5f}\n",
                   0.05 * double(i), harmonics[i].first, harmonics[i].second, rays[i].first, rays[i].second, truth[i]);
    // Step by step and over the whole band: 0.4 is all rays, 0.65 all harmonics.
    const auto expectStep = [&](size_t before, size_t after)
    {
        const double step = std::log(harmonics[after].first / harmonics[before].first),
                     true_step = std::log(truth[after] / truth[before]);
        const double noise = std::hypot(harmonics[after].second / harmonics[after].first,
                                        harmonics[before].second / harmonics[before].first);
        fmt::print("  {:.2f} to {:.2f}: step {:+.4f}, of the reference {:+.4f}, standard error {:.4f}\n",
                   0.05 * double(before), 0.05 * double(after), step, true_step, noise);
        EXPECT_LE(std::abs(step - true_step), 4 * noise);
    };
    for (size_t i = 8; i < 13; ++i)
        expectStep(i, i + 1);
    expectStep(8, 13);
}

TEST_F(GlossyRamp, GivesWayToRaysInAStandingPicture)
{
    SceneBuilder builder;
    const auto scene = load(strips(builder));
    const auto second = [&](GlossyMode mode) // frame: twice the mean of both, less the first
    {
        const Picture one = renderGi(*scene, camera(), settings(mode), 1, kWidth, kHeight),
                      two = renderGi(*scene, camera(), settings(mode), 2, kWidth, kHeight);
        std::vector<double> radiance;
        for (size_t i = 0; i < one.pixels.size(); ++i)
            radiance.push_back(2.0 * two.pixels[i].y - one.pixels[i].y);
        return radiance;
    };
    const auto with_harmonics = second(GlossyMode::kHarmonics), with_rays = second(GlossyMode::kRays);
    for (size_t i = 0; i < with_rays.size(); ++i)
        EXPECT_NEAR(with_harmonics[i], with_rays[i], 1e-4 * (1 + with_rays[i])) << i; // rounding of sums
}
} // namespace
