// Dispersion as it runs on the device, against Snell's law for the index of each channel.
#include "tests/stages/lobes_test.h"

namespace
{
/// Reflectance of a transmissive boundary: by the Fresnel equations for its own index ratio, rescaled to that of the material's
/// index where light arrives along the normal.
double channelReflectance(double ior, double eta, double cosine)
{
    const double sine2 = (1 - cosine * cosine) / square(eta);
    if (sine2 >= 1)
        return 1;
    const double behind = std::sqrt(1 - sine2);
    const double parallel = (eta * cosine - behind) / (eta * cosine + behind);
    const double perpendicular = (cosine - eta * behind) / (cosine + eta * behind);
    const double exact = (square(parallel) + square(perpendicular)) / 2;
    const double own = square((eta - 1) / (eta + 1)), stated = square((ior - 1) / (ior + 1));
    return stated + (1 - stated) * (exact - own) / (1 - own);
}

/// Red is bent least and blue most, each by the index that KHR_materials_dispersion gives it, into the body and out of it. Every
/// draw represents one channel, and the three are equally likely.
TEST_F(Lobes, DispersionBendsBlueMost)
{
    const double ior = 1.5, dispersion = 10;
    const double half_spread = (ior - 1) * 0.025 * dispersion;
    const std::array<double, 3> iors{ior - half_spread, ior, ior + half_spread};
    for (const bool front : {true, false})
        for (const double degrees :
             {10.0, 35.0}) // all three leave the body: red's critical angle is 46.7 degrees, blue's 38
        {
            gpu::BsdfDrawParams glass = white(degrees);
            glass.roughness = 0;
            glass.specular = 1;
            glass.transmission = 1;
            glass.ior = float(ior);
            glass.dispersion = float(dispersion);
            glass.front = front ? 1 : 0;
            const double sine = std::sqrt(1 - square(glass.wo.z));
            std::array<std::vector<double>, 3> weights;
            std::array<double, 3> sines{}; // of the angles that they leave at
            for (const gpu::BsdfDraw& d : drawn(glass))
            {
                const std::array<float, 3> w{d.weight.x, d.weight.y, d.weight.z};
                if (d.direction.z > 0) // reflected light is not parted
                    continue;
                ASSERT_EQ(std::ranges::count(w, 0.0f), 2);
                for (size_t c = 0; c < 3; ++c)
                    if (w[c] > 0)
                    {
                        const double eta = front ? iors[c] : 1 / iors[c];
                        const Double3 want(-glass.wo.x / eta, -glass.wo.y / eta, -std::sqrt(1 - square(sine / eta)));
                        // Its z comes from a difference, which grows as 1 / z.
                        ASSERT_LE(length(Double3(d.direction) - want), kTensOfRoundings / std::abs(want.z))
                            << degrees << ", " << c;
                        weights[c].push_back(w[c]);
                        sines[c] = std::hypot(d.direction.x, d.direction.y);
                    }
            }
            // Against the angle without a boundary: towards the normal on the way in, away from it on the way out.
            EXPECT_LT(std::abs(sines[0] - sine), std::abs(sines[1] - sine));
            EXPECT_LT(std::abs(sines[1] - sine), std::abs(sines[2] - sine));
            for (size_t c = 0; c < 3; ++c)
            {
                const double eta = front ? iors[c] : 1 / iors[c], count = double(weights[c].size());
                double sum = 0;
                for (const double w : weights[c])
                    sum += w;
                // A third of the draws, less those that the surface reflects, each worth three over the index ratio's square.
                const double reflected = channelReflectance(ior, eta, glass.wo.z);
                const double expected = kDraws / 3.0 * (1 - reflected);
                EXPECT_NEAR(count, expected, 4.5 * std::sqrt(expected)) << degrees << ", channel " << c;
                EXPECT_NEAR(sum / count * square(eta), 3, 3 * kTensOfRoundings) << degrees << ", channel " << c;
            }
        }
}
} // namespace
