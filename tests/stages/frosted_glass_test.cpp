// Frosted glass: rough lobes of transmission let light through, wherever a path meets them.
#include "tests/stages/gi_test.h"
#include "tools/compare/distributions.h"

#include <cmath>

namespace
{
constexpr uint32_t kSide = 16, kSeeds = 6; // pixels
constexpr double kChance = 0.001;          // of a false alarm

nlohmann::json frosted(double roughness, bool solid)
{
    nlohmann::json material{{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", roughness}}},
                            {"doubleSided", true},
                            {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 1}}}}}};
    if (solid)
        material["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.3}};
    return material;
}

double meanOf(const Picture& picture)
{
    double sum = 0;
    for (const gpu::vec3& pixel : picture.pixels)
        sum += pixel.y;
    return sum / double(picture.pixels.size());
}

class FrostedGlass : public GiTest
{
protected:
    /// In a glowing, reflecting sphere a pane that fills the picture shows as much light in mode gi as in mode reference.
    void expectReferenceLight(const std::string& what, double roughness, bool solid)
    {
        SceneBuilder builder;
        builder.sphere({0, 0, 0}, -1, 12, false,
                       builder.material(
                           with(emitter(0.5), {{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.5, 0.5, 1}}}}})));
        const int glass = builder.material(frosted(roughness, solid));
        if (solid)
            builder.box({-0.4f, -0.4f, -0.7f}, {0.4f, 0.4f, -0.4f}, glass);
        else
            builder.quad({-0.6f, -0.6f, -0.4f}, {1.2f, 0, 0}, {0, 1.2f, 0}, glass);
        const auto scene = load(builder.compile());
        const Camera camera{.name = "",
                            .position = {0.05f, 0.03f, 0.2f},
                            .forward = {0, 0, -1},
                            .up = {0, 1, 0},
                            .vertical_fov = 0.9f,
                            .orthographic_height = 0};
        const double truth =
            meanOf(render(*scene, camera, {.reference_depth = 24}, 512, kSide, kSide, Mode::kReference));
        Settings settings = smallSettings();
        settings.photon_count = 20000; // with fewer, nodes of the cut are larger than the glass is thick
        settings.photon_capacity = 320000;
        double sum = 0, squares = 0;
        for (uint32_t seed = 1; seed <= kSeeds; ++seed)
        {
            const double ratio = meanOf(renderGi(*scene, camera, settings, 8, kSide, kSide, seed)) / truth;
            sum += ratio;
            squares += ratio * ratio;
        }
        // Within 2 %, as a picture of one frame is to be: Student's test of what is beyond. At roughness 0.2 one seed deviates by 3 to
        // 4 % (12 seeds); with the largest error the test still finds pictures that are darker or brighter by a third.
        constexpr double kBias = 0.02, kLargestError = 0.03;
        const double mean = sum / kSeeds,
                     error = std::sqrt(std::max(squares / kSeeds - mean * mean, 0.0) / (kSeeds - 1));
        const double beyond = std::abs(mean - 1) - kBias, p = beyond <= 0 ? 1 : studentP(beyond / error, kSeeds - 1);
        fmt::print("  {}: {:.4f} +- {:.4f} of the reference's {:.4f}, p {:.2g}\n", what, mean, error, truth, p);
        EXPECT_LE(error, kLargestError) << what << ": too noisy to tell";
        EXPECT_GE(p, kChance) << what;
    }
};

TEST_F(FrostedGlass, ThinPanesShowWhatIsBehindThem)
{
    expectReferenceLight("thin, roughness 0.4", 0.4, false);
}

/// A glossy ray meets the second face: it goes on through wide lobes and narrow ones.
TEST_F(FrostedGlass, SolidPanesShowWhatIsBehindThem)
{
    expectReferenceLight("solid, roughness 0.6", 0.6, true);
    expectReferenceLight("solid, roughness 0.2", 0.2, true);
}
} // namespace
