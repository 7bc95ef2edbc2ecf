// The layers that glTF's extensions add (coat, sheen, grain, thin film, translucence), as they run on the device: choice of
// directions, energy, reciprocity, and what they reflect, against closed forms and integrals in double precision.
#include "tests/stages/lobes_test.h"

namespace
{
std::function<double(Double3)> mirroredDensity(gpu::vec3 wo, double along, double across)
{
    return [=](Double3 wi)
    {
        if (wi.z <= 0)
            return 0.0;
        const Double3 h = normalized(Double3(wo) + wi);
        return visibleNormals(along, across, wo, h) / (4 * dot(wo, h));
    };
}

TEST_F(Lobes, EachIsChosenByItsOwnDensity)
{
    ChiSquaredTests tests;
    for (const double degrees : {10.0, 60.0, 85.0})
    {
        gpu::BsdfDrawParams coat = none(degrees);
        coat.clearcoat = 0.8f;
        coat.clearcoat_roughness = 0.4f;
        addDraws(tests, fmt::format("coat, {} degrees", degrees), coat, 0.1, mirroredDensity(coat.wo, 0.16, 0.16));

        gpu::BsdfDrawParams brushed = white(degrees);
        brushed.metallic = 1;
        brushed.roughness = 0.3f;
        brushed.anisotropy = 0.7f;
        addDraws(tests, fmt::format("brushed metal, {} degrees", degrees), brushed, 0.1,
                 mirroredDensity(brushed.wo, 0.09 + 0.91 * 0.49, 0.09));

        gpu::BsdfDrawParams sheen = none(degrees);
        sheen.sheen = 1;
        sheen.sheen_roughness = 0.5f;
        addDraws(tests, fmt::format("sheen, {} degrees", degrees), sheen, 1e3,
                 [](Double3 wi) { return wi.z > 0 ? 0.5 / kPi : 0; });

        gpu::BsdfDrawParams leaf = white(degrees);
        leaf.diffuse_transmission = 1;
        addDraws(tests, fmt::format("leaf, {} degrees", degrees), leaf, 1e3,
                 [](Double3 wi) { return std::max(0.0, -wi.z) / kPi; });
    }
    tests.expectAll();
}

/// The density of all lobes together is that of the draws, and they find the energy that the value has: both by the
/// difference of two independent means, within 4.5 standard errors (10 cases fail by accident once in 15000).
TEST_F(Lobes, MixturesAreDrawnWithTheDensityThatTheyState)
{
    for (const double degrees : {20.0, 75.0})
        for (int mixture = 0; mixture < 5; ++mixture)
        {
            gpu::BsdfDrawParams m = white(degrees);
            m.base_color = 0.7f;
            m.specular = 1;
            m.roughness = 0.5f;
            if (mixture == 0 || mixture == 4)
                m.clearcoat = 1, m.clearcoat_roughness = 0.3f;
            if (mixture == 1 || mixture == 4)
                m.sheen = 0.8f, m.sheen_roughness = 0.4f;
            if (mixture == 2 || mixture == 4)
                m.diffuse_transmission = 0.6f, m.flags = gpu::kMaterialThin;
            if (mixture == 3)
                m.metallic = 0.5f, m.anisotropy = 0.6f, m.iridescence = 1, m.film_thickness = 350;
            const std::string what = fmt::format("mixture {}, {} degrees", mixture, degrees);
            std::vector<double> chosen, stated;
            for (const gpu::BsdfDraw& d : drawn(m))
                chosen.push_back(d.pdf > 0 ? 1 : 0);
            for (const gpu::BsdfDraw& d : drawn(m, gpu::kDrawValues))
                stated.push_back(4 * kPi * d.pdf);
            const Mean share = meanOf(chosen), density = meanOf(stated), found = albedo(m), there = evenAlbedo(m);
            EXPECT_LE(std::abs(share.value - density.value), 4.5 * std::hypot(share.error, density.error)) << what;
            EXPECT_LE(std::abs(found.value - there.value), 4.5 * std::hypot(found.error, there.error))
                << what << ": " << found.value << " and " << there.value;
        }
}

TEST_F(Lobes, AreReciprocal)
{
    gpu::BsdfDrawParams all = white(50);
    all.base_color = 0.7f;
    all.specular = 1;
    all.roughness = 0.4f;
    all.clearcoat = 1;
    all.clearcoat_roughness = 0.3f;
    all.sheen = 0.8f;
    all.sheen_roughness = 0.4f;
    all.anisotropy = 0.5f;
    all.iridescence = 1;
    all.film_thickness = 400;
    all.diffuse_transmission = 0.5f;
    all.flags = gpu::kMaterialThin;
    // Both orders share the half vector, and with it both distributions. They differ by the rounding of sums and products, and by
    // that of the half vector's cosine: the film's phase, up to 30 radians, has 8 roundings of it; a difference of it comes to the
    // colour times up to 5 by the matrix from XYZ; and that is 1/2 of the reflectance at least.
    constexpr double kBound = 64 * kUnit + 30 * 8 * 5 * 2 * kUnit;
    double worst = 0;
    uint32_t seen = 0;
    for (const gpu::BsdfDraw& d : drawn(all, gpu::kDrawValues))
        if (std::abs(d.direction.z) > 1e-3f) // cosines below 1e-4 are taken for that
        {
            ++seen;
            worst = std::max(worst, std::abs(double(d.weight.x) - d.reverse) / std::max(1e-3, double(d.reverse)));
        }
    std::cout << "  largest difference " << worst / kUnit << " of " << kBound / kUnit << " roundings\n";
    EXPECT_GT(seen, kDraws / 2);
    EXPECT_LE(worst, kBound);
}

/// In a white furnace: never more than 1, and nearly all of it where the layers lose nothing by themselves.
TEST_F(Lobes, KeepEnergyInAWhiteFurnace)
{
    const auto expectAlbedo = [&](const std::string& what, const gpu::BsdfDrawParams& m, double least)
    {
        const Mean a = albedo(m);
        std::cout << "  " << what << ": " << a.value << " (standard error " << a.error << ")\n";
        EXPECT_LE(a.value, 1 + 4.5 * a.error) << what;
        EXPECT_GE(a.value, least - 4.5 * a.error) << what;
    };
    for (const double degrees : {0.0, 40.0, 70.0, 85.0})
    {
        const std::string at = fmt::format(", {} degrees", degrees);
        for (const float roughness : {0.0f, 0.3f})
        {
            gpu::BsdfDrawParams m = white(degrees);
            m.clearcoat = 1;
            m.clearcoat_roughness = roughness;
            expectAlbedo(fmt::format("coat of roughness {} on white", roughness) + at, m, 0.95);
            m.metallic = 1;
            m.roughness = 0;
            expectAlbedo(fmt::format("coat of roughness {} on a mirror", roughness) + at, m, 0.95);
        }
        gpu::BsdfDrawParams leaf = white(degrees);
        leaf.diffuse_transmission = 0.5f;
        expectAlbedo("leaf" + at, leaf, 1 - 1e-6);
        gpu::BsdfDrawParams film = white(degrees);
        film.metallic = 1;
        film.roughness = 0;
        film.iridescence = 1;
        film.film_thickness = 400;
        expectAlbedo("film on a white mirror" + at, film, 0.95);
    }
}

TEST_F(Lobes, CoatReflectsBySchlickFrom4Percent)
{
    for (const double degrees : {0.0, 45.0, 75.0})
    {
        gpu::BsdfDrawParams coat = none(degrees);
        coat.clearcoat = 0.5f;
        const double cosine = std::cos(degrees * kPi / 180);
        const double want = 0.5 * (0.04 + 0.96 * std::pow(1 - cosine, 5));
        for (const gpu::BsdfDraw& d : drawn(coat)) // all of them the mirrored direction
        {
            ASSERT_NEAR(d.weight.x, want, kTensOfRoundings) << degrees;
            ASSERT_NEAR(d.direction.z, cosine, kTensOfRoundings);
            ASSERT_NEAR(d.direction.x, -coat.wo.x, kTensOfRoundings);
        }
    }
}

/// A coat with a normal of its own: its mirror and its lobe lie about that one, those of the metal below about the surface's.
TEST_F(Lobes, CoatFollowsItsOwnNormal)
{
    const double tilt = 12 * kPi / 180, turn = 2; // away from the viewer's plane
    const Double3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
    const auto mirrored = [](Double3 wo, Double3 n) { return 2 * dot(wo, n) * n - wo; };
    ChiSquaredTests tests;
    for (const double degrees : {10.0, 50.0})
    {
        gpu::BsdfDrawParams coated = white(degrees);
        coated.metallic = 1;
        coated.roughness = 0;
        coated.clearcoat = 1;
        coated.clearcoat_normal = {float(normal.x), float(normal.y), float(normal.z)};
        const Double3 wo = coated.wo, of_coat = mirrored(wo, normal), of_metal = mirrored(wo, {0, 0, 1});
        uint32_t by_coat = 0, by_metal = 0;
        for (const gpu::BsdfDraw& d : drawn(coated))
        {
            by_coat += length(Double3(d.direction) - of_coat) <= kTensOfRoundings ? 1 : 0;
            by_metal += length(Double3(d.direction) - of_metal) <= kTensOfRoundings ? 1 : 0;
        }
        EXPECT_EQ(by_coat + by_metal, kDraws);
        EXPECT_GT(by_metal, by_coat); // which reflects 4 % of what it sees from the front
        EXPECT_GT(by_coat, 0u);

        gpu::BsdfDrawParams rough = none(degrees);
        rough.clearcoat = 1;
        rough.clearcoat_roughness = 0.4f;
        rough.clearcoat_normal = coated.clearcoat_normal;
        const SphereGrid grid(of_coat, 0.1);
        std::vector<double> counts(grid.cellCount());
        for (const gpu::BsdfDraw& d : drawn(rough))
            ++counts[d.pdf > 0 ? grid.cellOf(d.direction) : grid.absorbedCell()];
        const Double3 side = normalized(Double3(normal.z, 0, -normal.x)), up = cross(normal, side);
        const auto local = [&](Double3 w) { return Double3(dot(w, side), dot(w, up), dot(w, normal)); };
        const auto density = [&](Double3 wi)
        {
            const Double3 v = local(wo), l = local(wi), h = normalized(v + l);
            return wi.z <= 0 || l.z <= 0 ? 0 : visibleNormals(0.16, 0.16, v, h) / (4 * dot(v, h));
        };
        tests.add(fmt::format("{} degrees", degrees), chiSquared(counts, times(kDraws, grid.integrate(density))));
    }
    tests.expectAll();
}

} // namespace
