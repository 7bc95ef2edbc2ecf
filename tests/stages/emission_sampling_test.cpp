// How photons leave lights on the device, guided ones, too, against densities on the CPU.
#include "shaders/guide/guide.h"
#include "tests/stages/light_sampling.h"

namespace
{
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
            b.light({{"type", "spot"},
                     {"intensity", 3},
                     {"spot", {{"innerConeAngle", kInner}, {"outerConeAngle", kOuter}}}},
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
            on_rim |=
                std::abs(1 - dot(start.direction, normalized(Double3(t.center) - from)) - coneHeight(t, from)) < 1e-5;
        ASSERT_TRUE(on_rim || std::abs(start.power.x / power - 1) < kRounding) << start.power.x << " " << power;
    }
    ChiSquaredTests tests;
    for (const gpu::CausticTarget& t : package_->causticTargets())
        tests.add("directions about a mirror",
                  directions(starts, SphereGrid(normalized(Double3(t.center) - from), widthFor(coneHeight(t, from))),
                             density));
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
            if (const size_t in =
                    discCell(start.origin, targets[i].center, {0, -1, 0}, targets[i].radius, kRings, kSlices);
                in < kCells)
                cell = i * kCells + in;
        ++counts[cell];
        const double area = kPi * sceneRadius() * sceneRadius();
        const double density =
            (1 - kAim) / area + (cell < 2 * kCells ? kAim / 2 / (kPi * std::pow(targets[cell / kCells].radius, 2)) : 0);
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
        const auto part = [](double x, size_t parts)
        { return std::min(size_t(std::max(x, 0.0) * double(parts)), parts - 1); };
        const Double3 d = normalized(start.direction);
        const size_t place =
            part(start.origin.x / kWidth + 0.5, kPlaces) * kPlaces + part(start.origin.z / kDepth + 0.5, kPlaces);
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
        std::vector<double> counts(sides * LampCells::kCount),
            expected(counts.size(), double(kDraws) / double(counts.size()));
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
        const auto is_within = [&](size_t t)
        { return 1 - dot(d, normalized(Double3(targets[t].center) - from)) <= coneHeight(targets[t], from); };
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
        const size_t texel =
            size_t(std::min(uint32_t(v * size.y), size.y - 1)) * size.x + std::min(uint32_t(u * size.x), size.x - 1);
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
