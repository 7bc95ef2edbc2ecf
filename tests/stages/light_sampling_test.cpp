// Places and directions chosen on lights on the device, for points that they light and for photons that leave them,
// against densities on the CPU.
#include "tests/stages/sampling_test.h"
#include "shaders/guide/guide.h"

#include <cmath>
#include <optional>

namespace
{
constexpr double kSqrtHalf = std::numbers::sqrt2 / 2;
constexpr double kRounding = 1e-4; // of densities and powers: a few roundings of squares of distances and cosines

Double3 cross(Double3 a, Double3 b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A lamp of kWidth x kDepth metres that hangs kHeight over the origin and faces down.
constexpr double kWidth = 0.8, kDepth = 0.5, kHeight = 2.5, kRadiance = 5;
void addLamp(SceneBuilder& builder, const nlohmann::json& material)
{
    builder.quad({-0.4f, 2.5f, -0.25f}, {0.8f, 0, 0}, {0, 0, 0.5f}, builder.material(material));
}

class LightSampling : public Sampling
{
protected:
    /// A floor of 4 x 4 metres and whatever else `build` adds.
    template <typename Build>
    void open(const Build& build)
    {
        builder_ = std::make_unique<SceneBuilder>();
        builder_->floor(4, 0, builder_->material(lambert(0.5)));
        build(*builder_);
        const std::filesystem::path file = builder_->compile();
        scene_ = load(file);
        auto package = package::Package::open(file);
        check(bool(package), "{}", package ? "" : package.error().message);
        package_.emplace(std::move(*package));
    }

    std::vector<gpu::LightDraw> lit(gpu::vec3 point)
    {
        return draw<gpu::LightDraw>(testKernel("draw/light", scene_->constants()), *scene_,
                                    gpu::DrawParams{.count = kDraws, .seed = ++seed_, .aim = 0, .point = point});
    }
    std::vector<gpu::PhotonStart> emitted(float aim = 0)
    {
        return draw<gpu::PhotonStart>(testKernel("draw/emission", scene_->constants()), *scene_,
                                      gpu::DrawParams{.count = kDraws, .seed = ++seed_, .aim = aim, .point = {}});
    }
    static bool leaves(const gpu::PhotonStart& start) { return start.power.x > 0; }

    /// Directions of what leaves against their density per steradian.
    ChiSquared directions(const std::vector<gpu::PhotonStart>& starts, const SphereGrid& grid,
                          const std::function<double(Double3)>& density)
    {
        std::vector<double> counts(grid.cellCount());
        for (const gpu::PhotonStart& start : starts)
            ++counts[leaves(start) ? grid.cellOf(start.direction) : grid.absorbedCell()];
        return chiSquared(counts, times(kDraws, grid.integrate(density)));
    }

    /// Two mirrors, at which photons are aimed.
    static void addMirrors(SceneBuilder& builder)
    {
        const int metal = builder.material({{"pbrMetallicRoughness", {{"roughnessFactor", 0}}}});
        builder.sphere({0.9f, 0.5f, 0.4f}, 0.4f, 6, true, metal);
        builder.sphere({-0.9f, 0.3f, -0.2f}, 0.25f, 6, true, metal);
    }
    /// 1 - cos of the half angle under which a target is seen.
    static double coneHeight(const gpu::CausticTarget& t, Double3 from)
    {
        return 1 - std::sqrt(1 - double(t.radius) * t.radius / length2(Double3(t.center) - from));
    }
    double aimedDensity(Double3 from, Double3 direction) const
    {
        double sum = 0;
        for (const gpu::CausticTarget& t : package_->causticTargets())
        {
            const double height = coneHeight(t, from);
            if (1 - dot(direction, normalized(Double3(t.center) - from)) <= height)
                sum += 1 / (2 * kPi * height);
        }
        return sum / double(package_->causticTargets().size());
    }

    Double3 sceneCenter() const { return 0.5 * (Double3(scene_->info().bounds_min) + Double3(scene_->info().bounds_max)); }
    double sceneRadius() const
    {
        return 0.5 * length(Double3(scene_->info().bounds_max) - Double3(scene_->info().bounds_min)) * 1.0001;
    }
    /// Rings of equal area times slices of a disc about `center`, seen along `axis`; its last cell is all the rest.
    static size_t discCell(Double3 at, Double3 center, Double3 axis, double radius, size_t rings, size_t slices)
    {
        const Double3 side = normalized(cross(axis, std::abs(axis.x) < 0.9 ? Double3(1, 0, 0) : Double3(0, 1, 0)));
        const Double3 d = at - center;
        const double x = dot(d, side), y = dot(d, cross(axis, side)), r2 = (x * x + y * y) / (radius * radius);
        if (r2 >= 1)
            return rings * slices;
        const double slice = std::atan2(y, x) / (2 * kPi) + 0.5;
        return size_t(r2 * double(rings)) * slices + std::min(size_t(slice * double(slices)), slices - 1);
    }

    std::unique_ptr<SceneBuilder> builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<package::Package> package_;
    uint32_t seed_ = 100;
};

/// The ring width with which a cone ends between the 8th and the 9th of 12 rings: nothing jumps within a cell.
double widthFor(double cone_height)
{
    return 8 * cone_height / (16 - 12 * cone_height);
}

ImageF patternedMap()
{
    ImageF map{.width = 16, .height = 8, .rgb = {}};
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 16; ++x)
            map.rgb.insert(map.rgb.end(), {0.3f + 0.1f * float(y), y == 2 ? 3 : 0.5f, x == 5 && y == 2 ? 9 : 0.4f});
    return map;
}

nlohmann::json turned(double x, double y, double z) // quarter turns and less of what points to -z
{
    return {{"translation", {x, y, z}}, {"rotation", {-kSqrtHalf, 0, 0, kSqrtHalf}}};
}

// ---- For points that are lit ---------------------------------------------------------------------------------------

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
        tests.add(fmt::format("seen from ({}, {}, {})", point.x, point.y, point.z), chiSquared(counts, times(kDraws, grid.integrate(density))));
    }
    tests.expectAll();
}

TEST_F(LightSampling, EnvironmentIsSampledByItsImportanceMap)
{
    open([](SceneBuilder& b) { b.environment(patternedMap()); });
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
        const double u = 0.5 + std::atan2(to.z, to.x) / (2 * kPi), v = std::acos(to.y) / kPi;
        const auto x = std::min(uint32_t(u * size.x * kParts), size.x * kParts - 1);
        const auto y = std::min(uint32_t(v * size.y * kParts), size.y * kParts - 1);
        const size_t texel = size_t(y / kParts) * size.x + x / kParts;
        ++counts[texel * kParts * kParts + y % kParts * kParts + x % kParts];
        const double solid_angle = 2 * kPi * kPi * std::hypot(to.x, to.z) / double(texels.size());
        const double du = std::abs(u * size.x - std::round(u * size.x)), dv = std::abs(v * size.y - std::round(v * size.y));
        if (std::min(du, dv) > 1e-3) // on a texel's rim rounding may take its neighbour
            worst = std::max(worst, std::abs(d.pdf * solid_angle / texels[texel].probability - 1));
    }
    EXPECT_LE(worst, kRounding);
    ChiSquaredTests tests;
    tests.add("texels", chiSquared(counts, expected));
    tests.expectAll();
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

// ---- For photons ---------------------------------------------------------------------------------------------------

TEST_F(LightSampling, PointLightEmitsEverywhere)
{
    open([](SceneBuilder& b) { b.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {0.3, 2, -0.4}}}); });
    const auto starts = emitted();
    for (const gpu::PhotonStart& start : starts)
        ASSERT_NEAR(start.power.x, 4 * kPi * 3, kRounding * 40);
    ChiSquaredTests tests;
    tests.add("directions", directions(starts, SphereGrid({0, 0, 1}, 1e3), [](Double3) { return 1 / (4 * kPi); }));
    tests.expectAll();
}

TEST_F(LightSampling, SpotEmitsEvenlyWithinItsConePhotonsOfItsFalloff)
{
    constexpr double kInner = 0.3, kOuter = 0.8;
    open(
        [&](SceneBuilder& b)
        {
            b.light({{"type", "spot"}, {"intensity", 3}, {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
                    turned(0.3, 2, -0.4));
        });
    const double height = 1 - std::cos(kOuter);
    auto starts = emitted();
    for (gpu::PhotonStart& start : starts)
    {
        const double across = (-double(start.direction.y) - std::cos(kOuter)) / (std::cos(kInner) - std::cos(kOuter));
        const double want = 3 * std::pow(std::clamp(across, 0.0, 1.0), 2) * 2 * kPi * height;
        ASSERT_NEAR(start.power.x, want, kRounding * 6) << start.direction.y;
        start.power.x = 1; // those of the rim carry nothing, and are drawn nevertheless
    }
    ChiSquaredTests tests;
    tests.add("directions", directions(starts, SphereGrid({0, -1, 0}, widthFor(height)),
                                       [&](Double3 d) { return 1 + d.y <= height ? 1 / (2 * kPi * height) : 0; }));
    tests.expectAll();
}

TEST_F(LightSampling, PhotonsAreAimedAtMirrorsAsStated)
{
    constexpr float kAim = 0.6f;
    open(
        [](SceneBuilder& b)
        {
            addMirrors(b);
            b.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {0.3, 2, -0.4}}});
        });
    const Double3 from(0.3f, 2, -0.4f);
    ASSERT_EQ(package_->causticTargets().size(), 2u);
    const auto density = [&](Double3 d) { return (1 - kAim) / (4 * kPi) + kAim * aimedDensity(from, d); };
    const auto starts = emitted(kAim);
    for (const gpu::PhotonStart& start : starts)
    {
        const double power = 3 / density(start.direction);
        bool on_rim = false;
        for (const gpu::CausticTarget& t : package_->causticTargets())
            on_rim |= std::abs(1 - dot(start.direction, normalized(Double3(t.center) - from)) - coneHeight(t, from)) < 1e-5;
        ASSERT_TRUE(on_rim || std::abs(start.power.x / power - 1) < kRounding) << start.power.x << " " << power;
    }
    ChiSquaredTests tests;
    for (const gpu::CausticTarget& t : package_->causticTargets())
        tests.add("directions about a mirror",
                  directions(starts, SphereGrid(normalized(Double3(t.center) - from), widthFor(coneHeight(t, from))), density));
    tests.expectAll();
}

TEST_F(LightSampling, SunEmitsAcrossTheWholeScene)
{
    open([](SceneBuilder& b) { b.light({{"type", "directional"}, {"intensity", 2}}, turned(0, 0, 0)); });
    constexpr size_t kRings = 12, kSlices = 12;
    std::vector<double> counts(kRings * kSlices + 1), expected(counts.size(), double(kDraws) / (kRings * kSlices));
    expected.back() = 0;
    for (const gpu::PhotonStart& start : emitted())
    {
        ASSERT_NEAR(start.direction.y, -1, 1e-6);
        ASSERT_NEAR(start.power.x / (2 * kPi * sceneRadius() * sceneRadius()), 1, kRounding);
        ++counts[discCell(start.origin, sceneCenter(), {0, -1, 0}, sceneRadius(), kRings, kSlices)];
    }
    counts[(kRings - 1) * kSlices] += counts.back(); // rounding beyond the rim
    counts.back() = 0;
    ChiSquaredTests tests;
    tests.add("disc", chiSquared(counts, expected));
    tests.expectAll();
}

TEST_F(LightSampling, SunIsAimedAtMirrorsAsStated)
{
    constexpr float kAim = 0.6f;
    open(
        [](SceneBuilder& b)
        {
            addMirrors(b);
            b.light({{"type", "directional"}, {"intensity", 2}}, turned(0, 0, 0));
        });
    const auto targets = package_->causticTargets();
    ASSERT_EQ(targets.size(), 2u); // whose discs, seen along the sun, lie apart and within the scene's
    constexpr size_t kRings = 6, kSlices = 8, kCells = kRings * kSlices;
    std::vector<double> counts(2 * kCells + 1), expected(counts.size());
    for (size_t i = 0; i < 2; ++i)
    {
        const double inside = (1 - kAim) * std::pow(targets[i].radius / sceneRadius(), 2) + kAim / 2;
        std::fill_n(expected.begin() + std::ptrdiff_t(i * kCells), kCells, inside * kDraws / kCells);
    }
    expected.back() = kDraws;
    for (size_t i = 0; i < 2 * kCells; ++i)
        expected.back() -= expected[i];
    for (const gpu::PhotonStart& start : emitted(kAim))
    {
        size_t cell = 2 * kCells;
        for (size_t i = 0; i < 2; ++i)
            if (const size_t in = discCell(start.origin, targets[i].center, {0, -1, 0}, targets[i].radius, kRings, kSlices); in < kCells)
                cell = i * kCells + in;
        ++counts[cell];
        const double area = kPi * sceneRadius() * sceneRadius();
        const double density = (1 - kAim) / area + (cell < 2 * kCells ? kAim / 2 / (kPi * std::pow(targets[cell / kCells].radius, 2)) : 0);
        const bool on_rim = cell % kCells >= kCells - kSlices || cell == 2 * kCells;
        ASSERT_TRUE(on_rim || std::abs(start.power.x * density / 2 - 1) < kRounding) << start.power.x;
    }
    ChiSquaredTests tests;
    tests.add("discs", chiSquared(counts, expected));
    tests.expectAll();
}

/// Places on a lamp times directions by the square of their sine and about its normal: all equally likely.
struct LampCells
{
    static constexpr size_t kPlaces = 4, kSines = 4, kSlices = 4, kCount = kPlaces * kPlaces * kSines * kSlices;

    static size_t of(const gpu::PhotonStart& start)
    {
        const auto part = [](double x, size_t parts) { return std::min(size_t(std::max(x, 0.0) * double(parts)), parts - 1); };
        const Double3 d = normalized(start.direction);
        const size_t place = part(start.origin.x / kWidth + 0.5, kPlaces) * kPlaces + part(start.origin.z / kDepth + 0.5, kPlaces);
        const size_t slice = part(std::atan2(d.z, d.x) / (2 * std::numbers::pi) + 0.5, kSlices);
        return (place * kSines + part(d.x * d.x + d.z * d.z, kSines)) * kSlices + slice;
    }
};

TEST_F(LightSampling, LampsEmitEvenlyOverTheirAreaByTheCosine)
{
    ChiSquaredTests tests;
    for (const bool two_sided : {false, true})
    {
        open([&](SceneBuilder& b) { addLamp(b, with(emitter(kRadiance), {{"doubleSided", two_sided}})); });
        const size_t sides = two_sided ? 2 : 1;
        std::vector<double> counts(sides * LampCells::kCount), expected(counts.size(), double(kDraws) / double(counts.size()));
        for (const gpu::PhotonStart& start : emitted())
        {
            ASSERT_NEAR(start.power.x / (double(sides) * kPi * kRadiance * kWidth * kDepth), 1, kRounding);
            ASSERT_TRUE(two_sided || start.direction.y < 0);
            ++counts[(start.direction.y > 0 ? LampCells::kCount : 0) + LampCells::of(start)];
        }
        tests.add(two_sided ? "two sides" : "one side", chiSquared(counts, expected));
    }
    tests.expectAll();
}

TEST_F(LightSampling, LampsPhotonsAreAimedAtMirrorsAsStated)
{
    constexpr float kAim = 0.6f;
    open(
        [](SceneBuilder& b)
        {
            addMirrors(b);
            addLamp(b, emitter(kRadiance));
        });
    // A place and: about the first mirror, about the second one, elsewhere. Both cones lie below the lamp and apart.
    constexpr size_t kPlaces = 4, kSteps = 16; // each way, and points within a place
    std::vector<double> counts(3 * kPlaces * kPlaces), expected(counts.size());
    const auto targets = package_->causticTargets();
    for (size_t i = 0; i < kPlaces * kSteps; ++i)
        for (size_t k = 0; k < kPlaces * kSteps; ++k)
        {
            const auto along = [](size_t x) { return (double(x) + 0.5) / (kPlaces * kSteps) - 0.5; };
            const Double3 from(along(i) * kWidth, kHeight, along(k) * kDepth);
            const size_t cell = 3 * (i / kSteps * kPlaces + k / kSteps);
            const double share = double(kDraws) / double(kPlaces * kPlaces * kSteps * kSteps);
            double elsewhere = 1;
            for (size_t t = 0; t < 2; ++t)
            {
                const Double3 axis = normalized(Double3(targets[t].center) - from);
                const double height = coneHeight(targets[t], from);
                // The cosine over pi integrates to that of the axis times the squared sine of the half angle.
                const double within = (1 - kAim) * -axis.y * height * (2 - height) + kAim / 2;
                expected[cell + t] += share * within;
                elsewhere -= within;
            }
            expected[cell + 2] += share * elsewhere;
        }
    uint32_t wrong = 0;
    for (const gpu::PhotonStart& start : emitted(kAim))
    {
        const Double3 d = normalized(start.direction), from = start.origin;
        const double density = (1 - kAim) * -d.y / kPi + kAim * aimedDensity(from, d);
        wrong += std::abs(start.power.x * density / (kRadiance * -d.y * kWidth * kDepth) - 1) > kRounding;
        const auto is_within = [&](size_t t) { return 1 - dot(d, normalized(Double3(targets[t].center) - from)) <= coneHeight(targets[t], from); };
        const auto place = [](double x) { return std::min(size_t((x + 0.5) * kPlaces), kPlaces - 1); };
        const size_t cell = 3 * (place(from.x / kWidth) * kPlaces + place(from.z / kDepth));
        ++counts[cell + (is_within(0) ? 0 : is_within(1) ? 1 : 2)];
    }
    // On a cone's rim rounding decides: of 1e-6 m at the lamp, where the cones are half a metre wide.
    EXPECT_LE(wrong, 1e-4 * kDraws);
    ChiSquaredTests tests;
    tests.add("places and mirrors", chiSquared(counts, expected));
    tests.expectAll();
}

TEST_F(LightSampling, EnvironmentEmitsByItsImportanceMapAcrossTheWholeScene)
{
    open([](SceneBuilder& b) { b.environment(patternedMap()); });
    const gpu::uvec2 size = scene_->info().environment_importance_size;
    const auto texels = package_->environmentTexels();
    constexpr size_t kRings = 2, kSlices = 4, kCells = kRings * kSlices;
    std::vector<double> counts(texels.size() * kCells), expected;
    for (const gpu::EnvironmentTexel& texel : texels)
        expected.insert(expected.end(), kCells, double(texel.probability) / kCells * kDraws);
    for (const gpu::PhotonStart& start : emitted())
    {
        const Double3 to = normalized(-1 * Double3(start.direction));
        const double u = 0.5 + std::atan2(to.z, to.x) / (2 * kPi), v = std::acos(to.y) / kPi;
        const size_t texel = size_t(std::min(uint32_t(v * size.y), size.y - 1)) * size.x + std::min(uint32_t(u * size.x), size.x - 1);
        const size_t cell = discCell(start.origin, sceneCenter(), start.direction, sceneRadius(), kRings, kSlices);
        ++counts[texel * kCells + std::min(cell, kCells - 1)]; // beyond the rim by rounding
    }
    ChiSquaredTests tests;
    tests.add("texels and places", chiSquared(counts, expected));
    tests.expectAll();
}

// ---- Guided photons ------------------------------------------------------------------------------------------------

/// A learned distribution with empty groups and cells, and one cell that holds a third of its group.
gpu::GuideDistribution unevenDistribution(std::vector<double>& probabilities)
{
    gpu::GuideDistribution d{};
    const std::array<double, gpu::kGuideGroups> groups{0.3, 0.05, 0, 0, 0.15, 0, 0, 0.5};
    double before = 0;
    for (uint32_t g = 0; g < gpu::kGuideGroups; ++g)
    {
        d.groups[g] = g + 1 == gpu::kGuideGroups ? 1 : float(before += groups[g]);
        std::vector<double> weights;
        for (uint32_t i = 0; i < gpu::kGuideCells; ++i)
            weights.push_back(i % 7 == 3 ? 0 : i == 500 ? 1000 : 1 + i % 5);
        double total = 0, running = 0;
        for (const double w : weights)
            total += w;
        for (uint32_t i = 0; i < gpu::kGuideCells; ++i)
        {
            running += weights[i];
            d.cells[g * gpu::kGuideCells + i] = i + 1 == gpu::kGuideCells ? 1 : float(running / total);
            probabilities.push_back(groups[g] * weights[i] / total);
        }
    }
    return d;
}

TEST_F(Sampling, GuidedPhotonsChooseCellsAsLearnedAndPlacesWithinEvenly)
{
    std::vector<double> probabilities;
    const gpu::GuideDistribution uneven = unevenDistribution(probabilities);
    const Buffer distribution = device().upload<gpu::GuideDistribution>("test.distribution", std::span(&uneven, 1));
    const Buffer draws = device().array<gpu::CellDraw>("test.draws", kDraws);
    Recorder rec(device());
    rec.begin(anyScene().descriptorSet());
    rec.run(testKernel("draw/guide"), kDraws, gpu::DrawParams{.count = kDraws, .seed = 1, .aim = 0, .point = {}},
            {{"Distribution", distribution}, {"Draws", draws}}); // Groups is not read
    rec.submitAndWait();
    constexpr size_t kParts = 16; // of what is left of the random number
    std::vector<double> counts(probabilities.size()), part_counts(kParts);
    for (const gpu::CellDraw& d : device().download<gpu::CellDraw>(draws, kDraws))
    {
        ASSERT_LT(d.cell, gpu::kGuideTotal);
        ASSERT_GT(probabilities[d.cell], 0) << "cell " << d.cell;
        ASSERT_TRUE(d.rest >= 0 && d.rest < 1);
        ++counts[d.cell];
        ++part_counts[size_t(d.rest * kParts)];
    }
    ChiSquaredTests tests;
    tests.add("cells", chiSquared(counts, times(kDraws, probabilities)));
    tests.add("places within", chiSquared(part_counts, std::vector<double>(kParts, double(kDraws) / kParts)));
    tests.expectAll();
}
} // namespace
