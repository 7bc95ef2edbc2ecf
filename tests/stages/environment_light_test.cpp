// Light from an equirectangular map, against integration on the CPU of the map as it is filtered.
#include "tests/stages/closed_form.h"

#include <cmath>

namespace
{
constexpr double kAlbedo = 0.5;

template <typename Texel>
ImageF makeMap(uint32_t width, uint32_t height, const Texel& texel)
{
    ImageF map{.width = width, .height = height, .rgb = {}};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (const double channel : texel(x, y))
                map.rgb.push_back(float(channel));
    return map;
}

ImageF constantMap(double radiance)
{
    return makeMap(8, 4, [&](uint32_t, uint32_t) { return grey(radiance); });
}

/// Red: a gradient in the texel centre's height. Green: one bright row, dark elsewhere. Blue: one bright texel.
ImageF patternedMap()
{
    constexpr uint32_t kWidth = 16, kHeight = 8;
    return makeMap(kWidth, kHeight,
                   [](uint32_t x, uint32_t y) -> Rgb {
                       return {1 + std::cos(kPi * (y + 0.5) / kHeight), y == 2 ? 3 : 0.5, x == 5 && y == 2 ? 9 : 0.4};
                   });
}

/// Bilinear: u repeats, v clamps (format/gpu_scene.h).
Rgb filtered(const ImageF& map, double u, double v)
{
    const double x = u * map.width - 0.5, y = std::clamp(v * map.height - 0.5, 0.0, map.height - 1.0);
    const double x0 = std::floor(x), y0 = std::floor(y);
    Rgb sum{};
    for (const double dx : {0.0, 1.0})
        for (const double dy : {0.0, 1.0})
        {
            const auto column = size_t(std::fmod(x0 + dx + map.width, map.width));
            const size_t row = std::min(size_t(y0 + dy), size_t(map.height) - 1);
            const double weight = std::abs(1 - dx - (x - x0)) * std::abs(1 - dy - (y - y0));
            for (size_t c = 0; c < 3; ++c)
                sum[c] += weight * map.rgb[3 * (row * map.width + column) + c];
        }
    return sum;
}

gpu::vec3 directionAt(double u, double v)
{
    const double phi = (u - 0.5) * 2 * kPi, theta = v * kPi;
    return {float(std::sin(theta) * std::cos(phi)), float(std::cos(theta)), float(std::sin(theta) * std::sin(phi))};
}

/// Irradiance of a surface facing `normal`: midpoint rule over the whole map.
Rgb irradiance(const ImageF& map, gpu::vec3 normal)
{
    constexpr uint32_t kColumns = 1024, kRows = 512;
    Rgb sum{};
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column)
        {
            const double u = (column + 0.5) / kColumns, v = (row + 0.5) / kRows;
            const gpu::vec3 d = directionAt(u, v);
            const double cosine = double(d.x) * normal.x + double(d.y) * normal.y + double(d.z) * normal.z;
            if (cosine <= 0)
                continue;
            const double solid_angle = std::sin(v * kPi) * (kPi / kRows) * (2 * kPi / kColumns);
            const Rgb radiance = filtered(map, u, v);
            for (size_t c = 0; c < 3; ++c)
                sum[c] += radiance[c] * cosine * solid_angle;
        }
    return sum;
}

TEST_F(ClosedForm, ConstantEnvironmentShowsTheAlbedo)
{
    SceneBuilder builder;
    builder.floor(4, 0, builder.material(lambert(kAlbedo)));
    builder.environment(constantMap(2));
    const auto scene = load(builder.compile());
    expectBoth("floor", *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}), grey(2 * kAlbedo),
               {.side = 16, .sample_count = 64});
    expectBoth("sky", *scene, viewOf({0, 5, 0}, {0, -1, 0}), grey(2), {});
}

TEST_F(ClosedForm, PatternedEnvironmentLightsEverySideByItsIntegral)
{
    SceneBuilder builder;
    const int diffuse = builder.material(lambert(kAlbedo));
    builder.box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, diffuse);
    const ImageF map = patternedMap();
    builder.environment(map);
    const auto scene = load(builder.compile());
    for (const gpu::vec3 normal : {gpu::vec3{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}})
    {
        Rgb want = irradiance(map, normal);
        for (double& channel : want)
            channel *= kAlbedo / kPi;
        expectBoth(fmt::format("side ({}, {}, {})", normal.x, normal.y, normal.z), *scene,
                   viewOf(0.5f * normal, normal), want, {.side = 32, .sample_count = 256, .depth = 3});
    }
}

/// Turns by a rotation about +Y, right-handed: from +Z to +X by a quarter turn.
gpu::vec3 turned(gpu::vec3 d, float angle)
{
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * d.x + s * d.z, d.y, -s * d.x + c * d.z};
}

TEST_F(ClosedForm, ATurnedEnvironmentIsSeenAndLightsAsItsMapTurned)
{
    constexpr float kAngle = -2.5f;
    SceneBuilder builder;
    builder.box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, builder.material(lambert(kAlbedo)));
    const ImageF map = patternedMap();
    builder.environment(map, kAngle);
    const auto scene = load(builder.compile());
    const float* const rgb = &map.rgb[3 * (2 * map.width + 5)]; // of the bright texel
    const gpu::vec3 bright = turned(directionAt(5.5 / map.width, 2.5 / map.height), kAngle);
    expectBoth("bright texel", *scene, viewOf(3.0f * bright, -1.0f * bright), {rgb[0], rgb[1], rgb[2]}, {});
    Rgb want = irradiance(map, turned({1, 0, 0}, -kAngle));
    for (double& channel : want)
        channel *= kAlbedo / kPi;
    expectBoth("lit side", *scene, viewOf({0.5f, 0, 0}, {1, 0, 0}), want,
               {.side = 32, .sample_count = 128, .depth = 3});
}

/// The directions at a bright texel's rim must have the density with which they are chosen: where map and direction
/// disagree by a rounding error, a neighbour's density, a million times smaller, would be taken for it.
TEST_F(ClosedForm, ASunOfOneTexelGivesAllItsLight)
{
    constexpr uint32_t kWidth = 1024, kHeight = 512;
    for (const gpu::uvec2 sun : {gpu::uvec2{700, 0}, {0, 200}})
    {
        const ImageF map = makeMap(kWidth, kHeight,
                                   [&](uint32_t x, uint32_t y) { return grey(x == sun.x && y == sun.y ? 1e6 : 0.01); });
        SceneBuilder builder;
        builder.floor(4, 0, builder.material(lambert(kAlbedo)));
        builder.environment(map);
        const auto scene = load(builder.compile());
        // Midpoints of a finer grid than the texels, over the filtered sun; then the constant rest.
        double sum = 0;
        constexpr int kSteps = 256;
        for (int i = 0; i < kSteps; ++i)
            for (int k = 0; k < kSteps; ++k)
            {
                const double du = 2 * (i + 0.5) / kSteps - 1, dv = 2 * (k + 0.5) / kSteps - 1; // texels from its centre
                const double v = (sun.y + 0.5 + dv) / kHeight, theta = v * kPi;
                if (v <= 0)
                    continue;
                const double clamped = sun.y == 0 && dv < 0 ? 1 : 1 - std::abs(dv);
                sum += (1e6 - 0.01) * clamped * (1 - std::abs(du)) * std::sin(theta) * std::cos(theta);
            }
        const double cell = 2.0 / kSteps * (kPi / kHeight) * 2.0 / kSteps * (2 * kPi / kWidth);
        expectBoth(fmt::format("sun in texel ({}, {})", sun.x, sun.y), *scene, viewOf({0, 0, 0}, {0.3f, 1, 0.2f}),
                   grey(kAlbedo / kPi * (sum * cell + 0.01 * kPi)), {.side = 64, .sample_count = 480, .depth = 3});
    }
}

TEST_F(ClosedForm, EnvironmentSeenDirectlyIsItsTexel)
{
    SceneBuilder builder;
    builder.floor(1, -10, builder.material(lambert(0)));
    const ImageF map = patternedMap();
    builder.environment(map);
    const auto scene = load(builder.compile());
    for (const gpu::uvec2 texel : {gpu::uvec2{5, 2}, {4, 2}, {5, 3}, {0, 1}, {15, 6}, {8, 0}, {8, 7}})
    {
        const double u = (texel.x + 0.5) / map.width, v = (texel.y + 0.5) / map.height;
        const float* const rgb = &map.rgb[3 * (texel.y * map.width + texel.x)];
        expectBoth(fmt::format("texel ({}, {})", texel.x, texel.y), *scene,
                   viewOf({0, 0, 0}, -1.0f * directionAt(u, v)), {rgb[0], rgb[1], rgb[2]}, {});
    }
    expectBoth("between texels", *scene, viewOf({0, 0, 0}, -1.0f * directionAt(5.75 / 16, 3.0 / 8)),
               filtered(map, 5.75 / 16, 3.0 / 8), {});
}
} // namespace
