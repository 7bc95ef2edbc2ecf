// Places and directions that light sampling chooses for a point on the device, against densities on the CPU.
#include "tests/stages/light_sampling.h"

namespace
{
TEST_F(LightSampling, LampIsSampledByAreaOverItsSolidAngle)
{
    open([](SceneBuilder& b) { addLamp(b, emitter(kRadiance)); });
    ChiSquaredTests tests;
    for (const gpu::vec3 point : {gpu::vec3{0, 0, 0}, {0.7f, 1.5f, -0.4f}, {1.5f, 2.2f, 0}})
    {
        const auto density = [&](Double3 d)
        {
            const double t = (kHeight - point.y) / d.y;
            if (d.y <= 0 || std::abs(point.x + t * d.x) > kWidth / 2 || std::abs(point.z + t * d.z) > kDepth / 2)
                return 0.0;
            return t * t / (kWidth * kDepth * d.y);
        };
        const Double3 to_lamp = Double3(0, kHeight, 0) - Double3(point);
        const SphereGrid grid(normalized(to_lamp), 0.1 / length2(to_lamp));
        std::vector<double> counts(grid.cellCount());
        double worst = 0;
        for (const gpu::LightDraw& d : lit(point))
        {
            ++counts[d.distance > 0 ? grid.cellOf(d.direction) : grid.absorbedCell()];
            const double at_distance = double(d.distance) * d.distance / (kWidth * kDepth * d.direction.y);
            worst = std::max({worst, std::abs(d.pdf / at_distance - 1), std::abs(d.weight.x * d.pdf / kRadiance - 1)});
        }
        EXPECT_LE(worst, kRounding);
        tests.add(fmt::format("seen from ({}, {}, {})", point.x, point.y, point.z),
                  chiSquared(counts, times(kDraws, grid.integrate(density))));
    }
    tests.expectAll();
}

TEST_F(LightSampling, EnvironmentIsSampledByItsImportanceMapHoweverItIsTurned)
{
    for (const float rotation : {0.0f, 2.5f})
    {
        open([&](SceneBuilder& b) { b.environment(patternedMap(), rotation); });
        const gpu::uvec2 size = scene_->info().environment_importance_size;
        const auto texels = package_->environmentTexels();
        constexpr uint32_t kParts = 2; // of a texel each way
        std::vector<double> counts(texels.size() * kParts * kParts), expected;
        for (const gpu::EnvironmentTexel& texel : texels)
            expected.insert(expected.end(), kParts * kParts, double(texel.probability) / (kParts * kParts) * kDraws);
        double worst = 0;
        for (const gpu::LightDraw& d : lit({0, 0, 0}))
        {
            const Double3 to = normalized(d.direction);
            const double turns = 0.5 + (std::atan2(to.z, to.x) + double(rotation)) / (2 * kPi);
            const double u = turns - std::floor(turns), v = std::acos(to.y) / kPi;
            const auto x = std::min(uint32_t(u * size.x * kParts), size.x * kParts - 1);
            const auto y = std::min(uint32_t(v * size.y * kParts), size.y * kParts - 1);
            const size_t texel = size_t(y / kParts) * size.x + x / kParts;
            ++counts[texel * kParts * kParts + y % kParts * kParts + x % kParts];
            const double solid_angle = 2 * kPi * kPi * std::hypot(to.x, to.z) / double(texels.size());
            const double du = std::abs(u * size.x - std::round(u * size.x)),
                         dv = std::abs(v * size.y - std::round(v * size.y));
            if (std::min(du, dv) > 1e-3) // on a texel's rim rounding may take its neighbour
                worst = std::max(worst, std::abs(d.pdf * solid_angle / texels[texel].probability - 1));
        }
        EXPECT_LE(worst, kRounding);
        ChiSquaredTests tests;
        tests.add("texels", chiSquared(counts, expected));
        tests.expectAll();
    }
}

TEST_F(LightSampling, LightsArePickedByTheirShareOfThePower)
{
    open(
        [](SceneBuilder& b)
        {
            addLamp(b, emitter(kRadiance));
            b.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {0.5, 1, 0}}});
            b.light({{"type", "point"}, {"intensity", 0.2}}, {{"translation", {-0.5, 1, 0}}});
            b.light({{"type", "spot"}, {"intensity", 8}, {"spot", {{"outerConeAngle", 1.2}}}}, turned(0, 1, 1));
            b.light({{"type", "directional"}, {"intensity", 1}}, turned(0, 0, 0));
            b.environment(patternedMap());
        });
    const auto lights = package_->lights();
    std::vector<double> counts(lights.size()), expected;
    for (const gpu::Light& light : lights)
        expected.push_back(double(light.pmf) * kDraws);
    for (const gpu::LightDraw& d : lit({0, 0, 0}))
    {
        const Double3 at = double(d.distance) * Double3(d.direction);
        const auto is = [&](const gpu::Light& light)
        {
            if (light.kind == gpu::kLightEnvironment)
                return d.distance > 1e30f && d.pdf > 0;
            if (light.kind == gpu::kLightDirectional)
                return d.distance > 1e30f && d.pdf == 0;
            if (light.kind == gpu::kLightPoint || light.kind == gpu::kLightSpot)
                return d.pdf == 0 && length2(at - Double3(light.p0)) < 1e-6;
            const double side = at.x / kWidth - at.z / kDepth; // the lamp's diagonal runs from its first corner
            const Double3 center = 1 / 3.0 * (Double3(light.p0) + Double3(light.p1) + Double3(light.p2));
            return d.pdf > 0 && d.distance < 1e30f && side * (center.x / kWidth - center.z / kDepth) > 0;
        };
        const auto found = std::ranges::find_if(lights, is);
        ASSERT_NE(found, lights.end());
        ++counts[size_t(found - lights.begin())];
    }
    ChiSquaredTests tests;
    tests.add("picks", chiSquared(counts, expected));
    tests.expectAll();
}
} // namespace
