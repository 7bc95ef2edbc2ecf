// Directions that the BSDF chooses on the device, against densities integrated in double precision on the CPU.
#include "shaders/legs/legs.h"
#include "tests/stages/sampling_test.h"

namespace
{
struct Lobes // a material, as far as its choice of directions goes
{
    double metallic = 0, roughness = 1, transmission = 0, specular = 1, ior = 1.5;
    bool front = true, thin = false;

    double alpha() const { return roughness * roughness; }
    double eta() const { return front || thin ? ior : 1 / ior; }
};

double square(double x)
{
    return x * x;
}

/// Reflectance of the boundary by the Fresnel equations.
double exactFresnel(double cosine, double eta)
{
    const double sin2 = (1 - cosine * cosine) / (eta * eta);
    if (sin2 >= 1)
        return 1;
    const double behind = std::sqrt(1 - sin2);
    return (square((eta * cosine - behind) / (eta * cosine + behind)) +
            square((cosine - eta * behind) / (cosine + eta * behind))) /
           2;
}

/// Of the dielectric: transmissive ones by the Fresnel equations, others by Schlick; `specular` scales all of it.
double reflectance(const Lobes& m, double cosine)
{
    const double normal = square((m.ior - 1) / (m.ior + 1));
    if (m.transmission > 0)
        return m.specular * exactFresnel(cosine, m.eta());
    return m.specular * (normal + (1 - normal) * std::pow(1 - cosine, 5));
}

/// Walter et al. 2007, eq. 33 and 34; Heitz 2018, eq. 1.
double visibleNormals(double alpha, Double3 wo, Double3 h)
{
    if (h.z <= 0 || dot(wo, h) <= 0)
        return 0;
    const double tan2 = (1 - h.z * h.z) / (h.z * h.z), tan2_o = (1 - wo.z * wo.z) / (wo.z * wo.z);
    const double distribution = alpha * alpha / (std::numbers::pi * std::pow(h.z, 4) * square(alpha * alpha + tan2));
    const double masking = 2 / (1 + std::sqrt(1 + alpha * alpha * tan2_o));
    return masking * dot(wo, h) * distribution / wo.z;
}

/// Density with which the BSDF chooses wi: lobes in proportion to what they reflect for white light at wo, base
/// colour 1.
double density(const Lobes& m, Double3 wo, Double3 wi)
{
    const double fresnel = reflectance(m, wo.z);
    const double reflection = (1 - m.metallic) * fresnel + m.metallic, below = (1 - m.metallic) * (1 - fresnel);
    const double sum = reflection + below;
    const double passed = below * m.transmission / sum, diffuse = below * (1 - m.transmission) / sum;
    const auto mirrored = [&](Double3 to)
    {
        const Double3 h = normalized(wo + to);
        return visibleNormals(m.alpha(), wo, h) / (4 * dot(wo, h));
    };
    if (wi.z > 0)
        return diffuse * wi.z / std::numbers::pi + reflection / sum * mirrored(wi);
    if (wi.z == 0 || passed == 0)
        return 0;
    if (m.thin)
        return passed * mirrored({wi.x, wi.y, -wi.z});
    const double eta = m.eta();
    Double3 h = normalized(wo + eta * wi);
    if (h.z < 0)
        h = -1 * h;
    const double cos_o = dot(wo, h), cos_i = dot(wi, h);
    if (cos_o <= 0 || cos_i >= 0)
        return 0;
    return passed * visibleNormals(m.alpha(), wo, h) * eta * eta * std::abs(cos_i) /
           square(cos_o + eta * cos_i); // eq. 17
}

Double3 viewer(double degrees)
{
    const double angle = degrees * std::numbers::pi / 180, turn = 0.7; // no symmetry hides a mistake in x or y
    return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

gpu::vec3 single(Double3 v)
{
    return {float(v.x), float(v.y), float(v.z)};
}

class BsdfSampling : public Sampling
{
protected:
    std::vector<gpu::BsdfDraw> drawn(const Lobes& m, gpu::vec3 wo, bool visible_normals)
    {
        return draw<gpu::BsdfDraw>(
            testKernel("draw/bsdf"), anyScene(),
            gpu::BsdfDrawParams{.count = kDraws,
                                .seed = ++seed_,
                                .what = visible_normals ? gpu::kDrawVisibleNormals : gpu::kDrawDirections,
                                .front = m.front ? 1u : 0u,
                                .flags = m.thin ? gpu::kMaterialThin : 0u,
                                .base_color = 1,
                                .metallic = float(m.metallic),
                                .roughness = float(m.roughness),
                                .transmission = float(m.transmission),
                                .specular = float(m.specular),
                                .ior = float(m.ior),
                                .wo = wo});
    }

    /// Cells of the directions above the surface, of those below it, and what was absorbed.
    struct Grid
    {
        SphereGrid above, below;

        size_t absorbedCell() const { return above.absorbedCell() + below.absorbedCell(); }
        size_t cellOf(Double3 d) const { return d.z > 0 ? above.cellOf(d) : above.absorbedCell() + below.cellOf(d); }
        std::vector<double> integrate(const std::function<double(Double3)>& density) const
        {
            std::vector<double> all = above.integrate([&](Double3 d) { return d.z > 0 ? density(d) : 0; });
            const std::vector<double> under = below.integrate([&](Double3 d) { return d.z > 0 ? 0 : density(d); });
            const double absorbed = all.back() + under.back() - 1; // each is 1 - its own
            all.pop_back();
            all.insert(all.end(), under.begin(), under.end());
            all.back() = absorbed;
            return all;
        }
    };

    /// @param claimed the material whose density is held against the draws
    ChiSquared test(const Lobes& m, const Lobes& claimed, double degrees)
    {
        const gpu::vec3 wo = single(viewer(degrees));
        return against(
            drawn(m, wo, false), [&](Double3 wi) { return density(claimed, wo, wi); }, gridFor(m, degrees));
    }

    /// Adds the test of the material's own density, which must also be the one that the shader states.
    void add(ChiSquaredTests& tests, const std::string& what, const Lobes& m, double degrees)
    {
        const gpu::vec3 wo = single(viewer(degrees));
        const auto draws = drawn(m, wo, false);
        tests.add(what, against(
                            draws, [&](Double3 wi) { return density(m, wo, wi); }, gridFor(m, degrees)));
        double worst = 0; // part of what rounding may do
        for (const gpu::BsdfDraw& d : std::span(draws).first(kDraws / 20))
            if (d.pdf > 0)
            {
                const Double3 wi = normalized(d.direction);
                worst = std::max(worst, std::abs(d.pdf / density(m, wo, wi) - 1) / rounding(m, wo, wi));
            }
        EXPECT_LE(worst, 1) << what;
    }

    static ChiSquared against(const std::vector<gpu::BsdfDraw>& draws, const std::function<double(Double3)>& density,
                              const Grid& grid)
    {
        std::vector<double> counts(grid.absorbedCell() + 1);
        for (const gpu::BsdfDraw& d : draws)
            ++counts[d.pdf > 0 ? grid.cellOf(d.direction) : grid.absorbedCell()];
        return chiSquared(counts, times(kDraws, grid.integrate(density)));
    }

    /// Some roundings of results, and what some roundings of the directions change. D has 1 - h.z^2 (1 - alpha^2) in
    /// its denominator twice: as small as alpha^2, it errs by some units of the last place of 1.
    static double rounding(const Lobes& m, Double3 wo, Double3 wi)
    {
        constexpr double kUnit = 0x1p-24;
        const double exact = density(m, wo, wi);
        double sum = kUnit * (64 + 16 / square(m.alpha()));
        for (const Double3 step : {Double3(kUnit, 0, 0), {0, kUnit, 0}, {0, 0, kUnit}})
            sum += 16 *
                   (std::abs(density(m, wo, wi + step) / exact - 1) + std::abs(density(m, wo + step, wi) / exact - 1));
        return sum;
    }

    static constexpr double kWide = 1e3;
    static double narrow(const Lobes& m) { return 4 * square(m.alpha()); }
    /// Narrow about the mirrored direction, where it reflects at all, and about the one that passes.
    static Grid gridFor(const Lobes& m, double degrees)
    {
        const Double3 wo = viewer(degrees);
        if (m.specular == 0)
            return {SphereGrid({0, 0, 1}, kWide), SphereGrid({0, 0, -1}, kWide)};
        const double eta = m.thin ? 1 : m.eta(), sine2 = (1 - wo.z * wo.z) / (eta * eta);
        const Double3 passed = normalized({-wo.x / eta, -wo.y / eta, -std::sqrt(std::max(0.0, 1 - sine2))});
        return {SphereGrid({-wo.x, -wo.y, wo.z}, narrow(m)), SphereGrid(passed, narrow(m))};
    }

    uint32_t seed_ = 0;
};

TEST_F(BsdfSampling, DiffuseLobeIsCosineDistributed)
{
    ChiSquaredTests tests;
    const Lobes matt{.specular = 0};
    for (const double degrees : {0.0, 60.0, 89.0})
        add(tests, fmt::format("{} degrees", degrees), matt, degrees);
    tests.expectAll();
}

TEST_F(BsdfSampling, VisibleNormalsAreDistributedAsTheyAreSeen)
{
    ChiSquaredTests tests;
    for (const double roughness : {0.2, 0.6, 1.0})
        for (const double degrees : {0.0, 60.0, 89.0})
        {
            const Lobes m{.metallic = 1, .roughness = roughness};
            const gpu::vec3 wo = single(viewer(degrees));
            tests.add(fmt::format("roughness {}, {} degrees", roughness, degrees),
                      against(drawn(m, wo, true), [&](Double3 h) { return visibleNormals(m.alpha(), wo, h); },
                              {SphereGrid({0, 0, 1}, narrow(m)), SphereGrid({0, 0, -1}, kWide)}));
        }
    tests.expectAll();
}

TEST_F(BsdfSampling, ReflectionIsThatOfVisibleNormals)
{
    ChiSquaredTests tests;
    for (const double roughness : {0.1, 0.3, 1.0})
        for (const double degrees : {0.0, 45.0, 80.0, 89.0})
        {
            const Lobes metal{.metallic = 1, .roughness = roughness};
            const std::string what = fmt::format("roughness {}, {} degrees", roughness, degrees);
            add(tests, what, metal, degrees);
        }
    tests.expectAll();
}

TEST_F(BsdfSampling, LobesAreChosenByWhatTheyReflect)
{
    ChiSquaredTests tests;
    for (const Lobes& m :
         {Lobes{.roughness = 0.3}, {.metallic = 0.4, .roughness = 0.5}, {.roughness = 0.4, .transmission = 0.5}})
        for (const double degrees : {30.0, 85.0})
        {
            const std::string what =
                fmt::format("metallic {}, transmission {}, {} degrees", m.metallic, m.transmission, degrees);
            add(tests, what, m, degrees);
        }
    tests.expectAll();
}

/// Into the denser side and out of it, past the angle of total reflection (41.8 degrees), too.
TEST_F(BsdfSampling, RoughTransmissionRefractsVisibleNormalsBothWays)
{
    ChiSquaredTests tests;
    for (const bool front : {true, false})
        for (const double roughness : {0.15, 0.4})
            for (const double degrees : {0.0, 38.0, 60.0, 85.0})
            {
                const Lobes glass{.roughness = roughness, .transmission = 1, .front = front};
                const std::string what =
                    fmt::format("{}, roughness {}, {} degrees", front ? "inwards" : "outwards", roughness, degrees);
                add(tests, what, glass, degrees);
            }
    tests.expectAll();
}

TEST_F(BsdfSampling, ThinRoughTransmissionMirrorsReflectionThroughTheWall)
{
    ChiSquaredTests tests;
    for (const double roughness : {0.3, 0.6})
        for (const double degrees : {0.0, 60.0, 85.0})
        {
            const Lobes pane{.roughness = roughness, .transmission = 1, .thin = true};
            const std::string what = fmt::format("roughness {}, {} degrees", roughness, degrees);
            add(tests, what, pane, degrees);
        }
    tests.expectAll();
}

/// The test detects small errors of the density: 3 % of roughness, a layer that reflects a two-hundredth.
TEST_F(BsdfSampling, AWrongDensityIsFound)
{
    const Lobes metal{.metallic = 1, .roughness = 0.5}, rougher{.metallic = 1, .roughness = 0.515};
    EXPECT_LT(test(metal, rougher, 45).p, 1e-6);
    const Lobes matt{.specular = 0}, barely_coated{.specular = 0.1};
    EXPECT_LT(test(matt, barely_coated, 45).p, 1e-6);
}

// ---- Gathering rays ------------------------------------------------------------------------------------------------

TEST_F(Sampling, GatheringRaysAreCosineDistributedAboutAnyNormal)
{
    ChiSquaredTests tests;
    uint32_t seed = 0;
    for (const Double3 normal :
         {Double3(0, 0, 1), {0, 0, -1}, {1e-4, -1e-4, -1}, {0.6, -0.48, 0.64}, {-0.1, 0.99, -0.1}})
    {
        const gpu::vec3 about = single(normalized(normal));
        const SphereGrid grid(normalized(about), 1e3);
        std::vector<double> counts(grid.cellCount());
        for (const gpu::DirectionDraw& d :
             draw<gpu::DirectionDraw>(testKernel("draw/gather"), anyScene(),
                                      gpu::DrawParams{.count = kDraws, .seed = ++seed, .aim = 0, .point = about}))
            ++counts[grid.cellOf(d.direction)];
        const auto cosine = [&](Double3 d) { return std::max(0.0, dot(d, about)) / kPi; };
        tests.add(fmt::format("normal ({}, {}, {})", about.x, about.y, about.z),
                  chiSquared(counts, times(kDraws, grid.integrate(cosine))));
    }
    tests.expectAll();
}

/// Half of the pairs stay even, half go to cells as these count; of the density's two parts each draw's weight is the inverse.
TEST_F(Sampling, AimedGatheringRaysGoWhereLegsSay)
{
    std::vector<uint32_t> cells(gpu::kAimCells); // a streak over some cells, one bright cell, all others empty
    for (uint32_t c = 40; c < 56; ++c)
        cells[c] = gpu::kAimWhole / 32;
    cells[gpu::kAimCells - 1] = gpu::kAimWhole / 2;
    const Buffer counts = device().upload<uint32_t>("test.counts", cells);
    const Buffer draws = device().array<gpu::PairDraw>("test.draws", kDraws);
    Recorder rec(device());
    rec.begin(anyScene().descriptorSet());
    rec.run(testKernel("draw/aim"), kDraws, gpu::DrawParams{.count = kDraws, .seed = 1, .aim = 0, .point = {}},
            {{"Counts", counts}, {"Draws", draws}});
    rec.submitAndWait();
    constexpr size_t kParts = 4; // of a cell, each way
    std::vector<double> density(gpu::kAimCells), found(gpu::kAimCells), within(kParts * kParts), expected;
    for (size_t c = 0; c < density.size(); ++c)
    {
        density[c] = 1 - gpu::kAimMost + gpu::kAimMost * cells[c] * double(gpu::kAimCells) / gpu::kAimWhole;
        expected.push_back(density[c] * kDraws / gpu::kAimCells);
    }
    double weights = 0;
    for (const gpu::PairDraw& d : device().download<gpu::PairDraw>(draws, kDraws))
    {
        ASSERT_TRUE(d.pair.x >= 0 && d.pair.x < 1 && d.pair.y >= 0 && d.pair.y < 1);
        const double x = d.pair.x * gpu::kAimRows, y = d.pair.y * gpu::kAimColumns;
        const size_t cell = size_t(y) * gpu::kAimRows + size_t(x);
        const double to_rim = std::min(std::abs(x - std::round(x)), std::abs(y - std::round(y)));
        ASSERT_TRUE(d.cell == cell || to_rim < 1e-3) << d.cell << " " << cell; // the direction's cell but for rounding
        ASSERT_NEAR(d.weight * density[cell], 1, 1e-4);
        ++found[cell];
        ++within[size_t((y - std::floor(y)) * kParts) * kParts + size_t((x - std::floor(x)) * kParts)];
        weights += d.weight;
    }
    ChiSquaredTests tests;
    tests.add("cells", chiSquared(found, expected));
    tests.add("places within",
              chiSquared(within, std::vector<double>(within.size(), double(kDraws) / double(within.size()))));
    tests.expectAll();
    // The weights' mean is 1; none is above 1 / (1 - kAimMost), and so is no deviation of one.
    EXPECT_NEAR(weights / kDraws, 1, 4 / (1 - gpu::kAimMost) / std::sqrt(double(kDraws)));
}
} // namespace
