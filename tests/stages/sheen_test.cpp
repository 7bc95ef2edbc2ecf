// Sheen as it runs on the device, against integrals in double precision.
#include "tests/stages/lobes_test.h"

namespace
{
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

/// The lobe of Estevez and Kulla, 1/sr.
double plainSheen(double roughness, Double3 wo, Double3 wi)
{
    const double alpha = square(roughness);
    const Double3 h = normalized(wo + wi);
    const double distribution = (2 + 1 / alpha) * std::pow(1 - h.z * h.z, 0.5 / alpha) / (2 * std::numbers::pi);
    return distribution / (4 * wo.z * wi.z * (1 + sheenLambda(wo.z, alpha) + sheenLambda(wi.z, alpha)));
}

/// The same as the shader has it: less at grazing angles, where masking, a fit, lets more back than arrives.
double sheenLobe(double roughness, Double3 wo, Double3 wi)
{
    const auto kept = [&](double cosine) { return std::min(1.0, cosine / std::max(0.115 - roughness / 2.4, 1e-6)); };
    return kept(wo.z) * kept(wi.z) * plainSheen(roughness, wo, wi);
}

/// An integral, and by how much a sum of a quarter of the cells differs from it.
struct Integral
{
    double value = 0, error = 0;
};

/// Share of a white sky that a white sheen reflects, by the midpoint rule.
Integral sheenAlbedo(double roughness, double cosine, double (*lobe)(double, Double3, Double3) = sheenLobe)
{
    const Double3 wo(std::sqrt(1 - cosine * cosine), 0, cosine);
    const auto sum = [&](int steps)
    {
        double total = 0;
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k)
            {
                const double z = (i + 0.5) / steps, phi = std::numbers::pi * (k + 0.5) / steps,
                             r = std::sqrt(1 - z * z);
                total += z * lobe(roughness, wo, Double3(r * std::cos(phi), r * std::sin(phi), z));
            }
        return total / (steps * steps) * 2 * std::numbers::pi;
    };
    const double value = sum(240);
    return {value, std::abs(value - sum(120))};
}

/// What sheen.glsl states of its albedo: a fit, within this of the plain lobe's integral.
constexpr double kSheenFit = 0.022;

/// That fit. @param cosine from 0
double fittedSheenAlbedo(double r, double cosine)
{
    const double slope = std::exp(2.3285 + r * (-4.5197 + r * (4.0659 - r * 1.3875)) + 0.065993 / r);
    const double bend = std::exp(-0.01909 + r * (-0.3623 + r * (0.52337 - r * 0.4283)) + 0.0031312 / r);
    const double grazing = -0.57465 + r * (4.5766 + r * (-7.4482 + r * 3.5142)) - 0.053496 / r;
    return std::min(1.0, std::exp(-slope * std::pow(cosine, bend) - grazing));
}

/// Share of a white sky that comes back from white cloth: the sheen, and what it leaves of white light on its way to the diffuse
/// base and back, the greater of both directions' albedos taken away (KHR_materials_sheen).
Integral clothAlbedo(double roughness, double cosine)
{
    const auto sum = [&](int steps)
    {
        double left = 0;
        for (int i = 0; i < steps; ++i)
        {
            const double z = std::sqrt((i + 0.5) / steps); // equal steps of projected solid angle
            left += 1 - std::max(fittedSheenAlbedo(roughness, cosine), fittedSheenAlbedo(roughness, z));
        }
        return left / steps;
    };
    const Integral sheen = sheenAlbedo(roughness, cosine);
    return {sheen.value + sum(4000), sheen.error + std::abs(sum(4000) - sum(2000))};
}

/// In a white furnace, white cloth: the greater of two albedos is taken from the base, so that something is lost.
TEST_F(Lobes, ClothKeepsWhatItsAlbedosLeave)
{
    for (const double degrees : {0.0, 40.0, 70.0, 85.0})
        for (const float roughness : {0.1f, 0.3f, 0.7f})
        {
            gpu::BsdfDrawParams cloth = white(degrees);
            cloth.sheen = 1;
            cloth.sheen_roughness = roughness;
            const Integral want = clothAlbedo(roughness, cloth.wo.z);
            const Mean got = albedo(cloth);
            fmt::print("  roughness {}, {} degrees: {:.5f} (error {:.2g}), {:.5f}\n", roughness, degrees, got.value,
                       got.error, want.value);
            EXPECT_NEAR(got.value, want.value, 4.5 * got.error + want.error) << roughness << ", " << degrees;
            EXPECT_LE(got.value, 1 + kSheenFit + 4.5 * got.error) << roughness << ", " << degrees;
        }
}

/// Its own albedo is the integral of the lobe; from the base it takes what KHR_materials_sheen says, by a fit of that albedo.
TEST_F(Lobes, SheenReflectsItsIntegralAndScalesTheBaseByItsAlbedo)
{
    for (const float roughness : {0.25f, 0.5f, 0.9f})
        for (const double degrees : {20.0, 60.0, 80.0})
        {
            gpu::BsdfDrawParams sheen = none(degrees);
            sheen.sheen = 1;
            sheen.sheen_roughness = roughness;
            const Integral want = sheenAlbedo(roughness, sheen.wo.z);
            const Mean got = albedo(sheen);
            EXPECT_NEAR(got.value, want.value, 4.5 * got.error + want.error) << roughness << ", " << degrees;
            gpu::BsdfDrawParams cloth = white(degrees);
            cloth.sheen = 0.6f;
            cloth.sheen_roughness = roughness;
            cloth.count = 64;
            uint32_t tried = 0;
            for (const gpu::BsdfDraw& d : drawn(cloth, gpu::kDrawValues))
                if (d.direction.z > 0.1f)
                {
                    ++tried;
                    const Double3 wi = d.direction, h = normalized(Double3(cloth.wo) + wi);
                    const double lobe = sheenLobe(roughness, cloth.wo, wi);
                    const double fitted =
                        std::max(fittedSheenAlbedo(roughness, cloth.wo.z), fittedSheenAlbedo(roughness, wi.z));
                    const double taken = 0.6 * fitted;
                    // Powers and exponentials are good to 2^-21 times the exponent in Vulkan; 1 - h.z^2 cancels.
                    const double exponent = 0.5 / square(roughness);
                    const double relative = 64 * kUnit + exponent * 8 * (kUnit / (1 - h.z * h.z) + 0x1p-21);
                    EXPECT_NEAR(d.weight.x, 0.6 * lobe + (1 - taken) / kPi, 0.6 * lobe * relative + 64 * 0x1p-21 / kPi)
                        << roughness << ", " << degrees;
                }
            EXPECT_GT(tried, 10u);
        }
}

/// The fit against the integral, over what it was made for; and no more comes back than arrives.
TEST(SheenAlbedo, IsFittedAsWellAsItIsStated)
{
    double worst = 0, most = 0;
    for (const double roughness : {0.07, 0.1, 0.2, 0.5, 1.0})
        for (const double cosine : {0.01, 0.05, 0.2, 0.5, 0.95})
        {
            const Integral plain = sheenAlbedo(roughness, cosine, plainSheen), ours = sheenAlbedo(roughness, cosine);
            const double off = std::abs(fittedSheenAlbedo(roughness, cosine) - std::min(1.0, plain.value));
            EXPECT_LE(off, kSheenFit + plain.error) << roughness << ", " << cosine;
            EXPECT_LE(ours.value, 1 + ours.error) << roughness << ", " << cosine;
            worst = std::max(worst, off), most = std::max(most, ours.value);
        }
    for (const double roughness : {0.19, 0.21, 0.23, 0.25, 0.27}) // where most came back
        for (const double cosine : {0.004, 0.01, 0.02})
            most = std::max(most, sheenAlbedo(roughness, cosine).value);
    std::cout << "  the fit is at most " << worst << " off; at most " << most << " come back\n";
    EXPECT_LE(most, 1);
}
} // namespace
