// The layers that glTF's extensions add (coat, sheen, grain, thin film, translucence), as they run on the device: choice of
// directions, energy, reciprocity, and what they reflect, against closed forms and integrals in double precision.
#include "tests/stages/sampling_test.h"

namespace
{
gpu::vec3 viewer(double degrees)
{
    const double angle = degrees * std::numbers::pi / 180, turn = 0.7; // no symmetry hides a mistake in x or y
    return {float(std::sin(angle) * std::cos(turn)), float(std::sin(angle) * std::sin(turn)), float(std::cos(angle))};
}

double square(double x)
{
    return x * x;
}

/// Walter et al. 2007 and Heitz 2018 for unequal widths.
double visibleNormals(double along, double across, Double3 wo, Double3 h)
{
    if (h.z <= 0 || dot(wo, h) <= 0)
        return 0;
    const double d = square(h.x / along) + square(h.y / across) + h.z * h.z;
    const double lambda = (std::sqrt(1 + (square(along * wo.x) + square(across * wo.y)) / (wo.z * wo.z)) - 1) / 2;
    return dot(wo, h) / (wo.z * (1 + lambda) * std::numbers::pi * along * across * d * d);
}

/// Estevez and Kulla 2017: their fit of Lambda.
double sheenLambda(double cosine, double alpha)
{
    const auto curve = [&](double x)
    {
        const double t = square(1 - alpha);
        const auto mixed = [&](double one, double zero) { return one + t * (zero - one); };
        return mixed(21.5473, 25.3245) / (1 + mixed(3.82987, 3.32435) * std::pow(x, mixed(0.19823, 0.16801))) +
               mixed(-1.97760, -1.27393) * x + mixed(-4.32054, -4.85967);
    };
    return std::exp(cosine < 0.5 ? curve(cosine) : 2 * curve(0.5) - curve(1 - cosine));
}

/// Share of a white sky that the white sheen reflects, by the midpoint rule.
double sheenAlbedo(double roughness, double cosine)
{
    constexpr int kSteps = 400;
    const double alpha = roughness * roughness, sine = std::sqrt(1 - cosine * cosine);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
        for (int k = 0; k < kSteps; ++k)
        {
            const double z = (i + 0.5) / kSteps, phi = std::numbers::pi * (k + 0.5) / kSteps, r = std::sqrt(1 - z * z);
            const Double3 h = normalized(Double3(sine + r * std::cos(phi), r * std::sin(phi), cosine + z));
            const double distribution = (2 + 1 / alpha) * std::pow(1 - h.z * h.z, 0.5 / alpha) / (2 * std::numbers::pi);
            sum += distribution / (4 * cosine * (1 + sheenLambda(z, alpha) + sheenLambda(cosine, alpha)));
        }
    return sum / (kSteps * kSteps) * 2 * std::numbers::pi;
}

struct Mean
{
    double value = 0, error = 0; // standard
};

Mean meanOf(const std::vector<double>& values)
{
    double sum = 0, squares = 0;
    for (const double v : values)
        sum += v, squares += v * v;
    const double n = double(values.size()), mean = sum / n;
    return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / n)};
}

class Lobes : public Sampling
{
protected:
    /// A black surface without lobes: what a test adds is all there is.
    static gpu::BsdfDrawParams none(double degrees)
    {
        return {.count = kDraws,
                .seed = 0,
                .what = gpu::kDrawDirections,
                .front = 1,
                .flags = 0,
                .base_color = 0,
                .metallic = 0,
                .roughness = 1,
                .transmission = 0,
                .specular = 0,
                .ior = 1.5f,
                .wo = viewer(degrees),
                .clearcoat = 0,
                .clearcoat_roughness = 0,
                .sheen = 0,
                .sheen_roughness = 0,
                .anisotropy = 0,
                .iridescence = 0,
                .film_ior = 1.3f,
                .film_thickness = 0,
                .diffuse_transmission = 0};
    }
    static gpu::BsdfDrawParams white(double degrees)
    {
        gpu::BsdfDrawParams params = none(degrees);
        params.base_color = 1;
        return params;
    }

    std::vector<gpu::BsdfDraw> drawn(gpu::BsdfDrawParams params, uint32_t what = gpu::kDrawDirections)
    {
        params.what = what;
        params.seed = ++seed_;
        return draw<gpu::BsdfDraw>(testKernel("draw/bsdf"), anyScene(), params);
    }

    /// Share of a white sky all around that comes back, from chosen directions.
    Mean albedo(const gpu::BsdfDrawParams& params)
    {
        std::vector<double> weights;
        for (const gpu::BsdfDraw& d : drawn(params))
            weights.push_back(d.weight.x);
        return meanOf(weights);
    }

    /// The same from even directions: nothing of the sampler takes part. Without deltas.
    Mean evenAlbedo(const gpu::BsdfDrawParams& params)
    {
        std::vector<double> values;
        for (const gpu::BsdfDraw& d : drawn(params, gpu::kDrawValues))
            values.push_back(4 * kPi * d.weight.x * std::abs(d.direction.z));
        return meanOf(values);
    }

    /// Draws of a single lobe above the surface against its density.
    void addDraws(ChiSquaredTests& tests, const std::string& what, const gpu::BsdfDrawParams& params, double width,
                  const std::function<double(Double3)>& density)
    {
        const gpu::vec3 wo = params.wo;
        const SphereGrid grid({-wo.x, -wo.y, wo.z}, width);
        std::vector<double> counts(grid.cellCount());
        for (const gpu::BsdfDraw& d : drawn(params))
            ++counts[d.pdf > 0 ? grid.cellOf(d.direction) : grid.absorbedCell()];
        tests.add(what, chiSquared(counts, times(kDraws, grid.integrate(density))));
    }

    uint32_t seed_ = 1000;
};

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
        addDraws(tests, fmt::format("sheen, {} degrees", degrees), sheen, 1e3, [](Double3 wi) { return wi.z > 0 ? 0.5 / kPi : 0; });

        gpu::BsdfDrawParams leaf = white(degrees);
        leaf.diffuse_transmission = 1;
        addDraws(tests, fmt::format("leaf, {} degrees", degrees), leaf, 1e3, [](Double3 wi) { return std::max(0.0, -wi.z) / kPi; });
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
    double worst = 0;
    uint32_t seen = 0;
    for (const gpu::BsdfDraw& d : drawn(all, gpu::kDrawValues))
        if (std::abs(d.direction.z) > 0.01f) // the coat's cosine is divided out: rounding grows as 1 / z
        {
            ++seen;
            worst = std::max(worst, std::abs(d.weight.x - d.reverse * 1.0) / std::max(1e-3, double(d.reverse)));
        }
    EXPECT_GT(seen, kDraws / 2);
    // The coat is stated per cosine of the base's normal, which is the coat's here; the rest is symmetric up to rounding.
    EXPECT_LT(worst, 2e-3);
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
        for (const float roughness : {0.1f, 0.3f, 0.7f}) // what its own Smith terms lose is lost
        {
            gpu::BsdfDrawParams cloth = white(degrees);
            cloth.sheen = 1;
            cloth.sheen_roughness = roughness;
            expectAlbedo(fmt::format("sheen of roughness {} on white", roughness) + at, cloth, 0.85);
        }
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
            ASSERT_NEAR(d.weight.x, want, 1e-5) << degrees;
            ASSERT_NEAR(d.direction.z, cosine, 1e-5);
            ASSERT_NEAR(d.direction.x, -coat.wo.x, 1e-5);
        }
    }
}

/// Its own albedo is the integral of the lobe, and reduces the base as KHR_materials_sheen specifies; its albedo
/// there is a fit, good to 0.022.
TEST_F(Lobes, SheenReflectsItsIntegralAndScalesTheBaseByIt)
{
    for (const float roughness : {0.25f, 0.5f, 0.9f})
        for (const double degrees : {20.0, 60.0, 80.0})
        {
            gpu::BsdfDrawParams sheen = none(degrees);
            sheen.sheen = 1;
            sheen.sheen_roughness = roughness;
            const double cosine = std::cos(degrees * kPi / 180), want = sheenAlbedo(roughness, cosine);
            const Mean got = albedo(sheen);
            EXPECT_NEAR(got.value, want, 4.5 * got.error + 1e-3) << roughness << ", " << degrees; // 1e-3: the sum's steps
            gpu::BsdfDrawParams cloth = white(degrees);
            cloth.sheen = 0.6f;
            cloth.sheen_roughness = roughness;
            uint32_t tried = 0;
            cloth.count = 64;
            for (const gpu::BsdfDraw& d : drawn(cloth, gpu::kDrawValues))
                if (d.direction.z > 0.1f && tried < 6)
                {
                    ++tried;
                    const Double3 h = normalized(Double3(cloth.wo) + Double3(d.direction));
                    const double alpha = square(roughness), z = d.direction.z;
                    const double lobe = (2 + 1 / alpha) * std::pow(1 - h.z * h.z, 0.5 / alpha) / (2 * kPi) /
                                        (4 * z * cosine * (1 + sheenLambda(z, alpha) + sheenLambda(cosine, alpha)));
                    const double taken = 0.6 * std::max(want, sheenAlbedo(roughness, z));
                    EXPECT_NEAR(d.weight.x, 0.6 * lobe + (1 - taken) / kPi, 0.6 * 0.022 / kPi + 2e-4);
                }
            EXPECT_EQ(tried, 6u);
        }
}

/// CIE 1931 colour matching functions by the fits of Wyman, Sloan and Shirley 2013 (single errors about 1 %).
std::array<double, 3> colorMatching(double nm)
{
    const auto lobe = [&](double center, double below, double above)
    { return std::exp(-0.5 * square((nm - center) / (nm < center ? below : above))); };
    return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}

/// A film of index n on a base of index m, seen along the normal: Airy's sum at every wavelength, seen by the eye. What does
/// not change with the wavelength is white.
std::array<double, 3> airyColor(double n, double m, double thickness)
{
    const double outer = (1 - n) / (1 + n), inner = (n - m) / (n + m);
    const double r12 = outer * outer, r23 = inner * inner;
    const double mean = r12 + square(1 - r12) * r23 / (1 - r12 * r23);
    std::array<double, 3> xyz{}, sums{};
    for (double nm = 380; nm < 780; nm += 0.5)
    {
        const double phase = 4 * std::numbers::pi * n * thickness / nm;
        const double crossed = 2 * outer * inner * std::cos(phase);
        const double reflectance = (r12 + r23 + crossed) / (1 + r12 * r23 + crossed);
        const auto seen = colorMatching(nm);
        for (size_t c = 0; c < 3; ++c)
            xyz[c] += seen[c] * (reflectance - mean), sums[c] += seen[c];
    }
    for (size_t c = 0; c < 3; ++c)
        xyz[c] /= sums[c];
    return {mean + 3.2404542 * xyz[0] - 1.5371385 * xyz[1] - 0.4985314 * xyz[2],
            mean - 0.9692660 * xyz[0] + 1.8760108 * xyz[1] + 0.0415560 * xyz[2],
            mean + 0.0556434 * xyz[0] - 0.2040259 * xyz[1] + 1.0572252 * xyz[2]};
}

TEST_F(Lobes, ThinFilmsHaveTheColoursOfAirysSum)
{
    for (const float thickness : {200.0f, 350.0f, 550.0f})
    {
        gpu::BsdfDrawParams film = none(0);
        film.metallic = 1;
        film.roughness = 0;
        film.base_color = 0.25f; // of index 3
        film.iridescence = 1;
        film.film_ior = 1.4f;
        film.film_thickness = thickness;
        film.count = 1;
        const gpu::vec3 got = drawn(film).front().weight;
        const auto want = airyColor(1.4, 3, thickness);
        std::cout << "  " << thickness << " nm: " << got.x << " " << got.y << " " << got.z << ", Airy " << want[0] << " " << want[1]
                  << " " << want[2] << "\n";
        // Gaussians in the place of the eye's curves, and two harmonics of a sum whose third is (r12 r23)^(3/2) = 2e-4.
        EXPECT_NEAR(got.x, want[0], 0.02);
        EXPECT_NEAR(got.y, want[1], 0.02);
        EXPECT_NEAR(got.z, want[2], 0.02);
    }
}
} // namespace
