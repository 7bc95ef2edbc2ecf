// The colours of thin films as they run on the device, against Airy's sum at every wavelength.
#include "tests/stages/lobes_test.h"

namespace
{
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
    const auto shown = [&](double x, double y, double z)
    { return std::clamp(mean + x * xyz[0] + y * xyz[1] + z * xyz[2], 0.0, 1.0); };
    return {shown(3.2404542, -1.5371385, -0.4985314), shown(-0.9692660, 1.8760108, 0.0415560),
            shown(0.0556434, -0.2040259, 1.0572252)};
}

/// What thin_film.glsl states: Gaussians in the place of the eye's curves, and two harmonics, are off by a tenth of the
/// interference's swing at most.
TEST_F(Lobes, ThinFilmsHaveTheColoursOfAirysSum)
{
    struct Film
    {
        double ior, base_ior;
    };
    for (const Film f : {Film{1.4, 3}, {1.3, 1.5}, {2, 3}, {1.8, 6}})
    {
        const double swing = 4 * std::abs((1 - f.ior) / (1 + f.ior) * (f.ior - f.base_ior) / (f.ior + f.base_ior));
        std::vector<std::array<double, 3>> seen, airy;
        for (const double thickness : {200.0, 350.0, 550.0, 900.0})
        {
            gpu::BsdfDrawParams film = none(0);
            film.metallic = 1;
            film.roughness = 0;
            film.base_color = float(square((f.base_ior - 1) / (f.base_ior + 1)));
            film.iridescence = 1;
            film.film_ior = float(f.ior);
            film.film_thickness = float(thickness);
            film.count = 1;
            const gpu::vec3 got = drawn(film).front().weight;
            const std::array<double, 3> want = airyColor(f.ior, f.base_ior, thickness), shown{got.x, got.y, got.z};
            fmt::print("  {} on {}, {} nm: {:.4f} {:.4f} {:.4f}, Airy {:.4f} {:.4f} {:.4f}\n", f.ior, f.base_ior,
                       thickness, got.x, got.y, got.z, want[0], want[1], want[2]);
            for (size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(shown[c], want[c], swing / 10) << f.ior << ", " << thickness << " nm";
            seen.push_back(shown);
            airy.push_back(want);
        }
        for (size_t i = 0; i < seen.size(); ++i) // each is nearest to the colour of its own thickness
        {
            const auto distance = [&](const std::array<double, 3>& a)
            { return square(a[0] - seen[i][0]) + square(a[1] - seen[i][1]) + square(a[2] - seen[i][2]); };
            const auto nearest = std::ranges::min_element(airy, {}, distance);
            EXPECT_EQ(size_t(nearest - airy.begin()), i) << f.ior;
        }
    }
}
} // namespace
