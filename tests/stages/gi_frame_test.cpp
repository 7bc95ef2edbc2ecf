// The frame of global illumination as a whole: a furnace, equal bits, and degenerate scenes.
#include "shaders/lib/terms.h"
#include "tests/stages/gi_test.h"

#include <cstring>

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 40;

const Camera kCamera{.name = "",
                     .position = {0, 1, 0.95f},
                     .forward = {0, 0, -1},
                     .up = {0, 1, 0},
                     .vertical_fov = 1.2f,
                     .orthographic_height = 0};

class GiFrame : public GiTest
{
protected:
    /// Expects a closed room whose walls all glow to show what they emit and reflect without end.
    void expectFurnace(double albedo)
    {
        constexpr uint32_t kFrames = 24; // the last of which gather at every pixel
        Settings settings = smallSettings();
        settings.photon_count = 10000; // fewer make wider density estimates, which lose more light at the room's edges
        settings.sample_count = 512;   // as many rays as 17 a pixel
        settings.gather_rays = 64;
        SceneBuilder builder;
        const nlohmann::json glowing =
            with(emitter(1), {{"pbrMetallicRoughness", {{"baseColorFactor", {albedo, albedo, albedo, 1}}}}});
        builder.box({-1, 0, -1}, {1, 2, 1}, builder.material(glowing), true);
        const auto scene = load(builder.compile());
        const double truth = 1 / (1 - albedo);
        const Picture picture = renderGi(*scene, kCamera, settings, kFrames, kWidth, kHeight);
        double sum = 0, squares = 0, least = 1e30, most = 0;
        for (const gpu::vec3& pixel : picture.pixels)
        {
            sum += pixel.x;
            squares += double(pixel.x) * pixel.x;
            least = std::min(least, double(pixel.x));
            most = std::max(most, double(pixel.x));
        }
        const double n = double(picture.pixels.size()), mean = sum / n;
        fmt::print(
            "  albedo {}, {} frames: mean {:.4f} of the truth, standard deviation {:.4f}, pixels {:.3f} to {:.3f}\n",
            albedo, kFrames, mean / truth, std::sqrt(squares / n - mean * mean) / truth, least / truth, most / truth);
        EXPECT_NEAR(mean, truth, 0.01 * truth);
    }
};

TEST_F(GiFrame, IsAFurnaceWithHalfAbsorbed)
{
    expectFurnace(0.5);
}

TEST_F(GiFrame, IsAFurnaceWithAFifthAbsorbed)
{
    expectFurnace(0.8);
}

/// A room with a lamp, a mirror, glossy metal and glass.
std::filesystem::path room(SceneBuilder& scene)
{
    const auto metal = [](double roughness)
    {
        return nlohmann::json{
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {0.9, 0.6, 0.3, 1}}, {"metallicFactor", 1}, {"roughnessFactor", roughness}}}};
    };
    scene.box({-1, 0, -1}, {1, 2, 1}, scene.material(lambert(0.6)), true);
    scene.quad({-0.3f, 1.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, scene.material(emitter(8)));
    scene.sphere({-0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0)));
    scene.sphere({0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(metal(0.4)));
    scene.sphere({0, 0.9f, 0}, 0.25f, 12, true,
                 scene.material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
                                 {"extensions",
                                  {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                                   {"KHR_materials_volume", {{"thicknessFactor", 0.5}}}}}}));
    return scene.compile();
}

bool equalBits(const Picture& a, const Picture& b)
{
    return a.pixels.size() == b.pixels.size() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(gpu::vec3)) == 0;
}

/// So many that photons are guided.
void lamps(SceneBuilder& builder)
{
    for (int i = 0; i < 16; ++i)
        builder.light({{"type", "point"}, {"intensity", 0.1}}, {{"translation", {0.1 * i - 0.8, 1.5, 0.4}}});
}

TEST_F(GiFrame, GivesTheSameBitsForTheSameSeedAndOthersForAnother)
{
    SceneBuilder builder;
    lamps(builder);
    const auto scene = load(room(builder));
    Settings settings = smallSettings();
    settings.gather_rays = 256; // 17 a pixel: the last frames gather at every pixel
    const auto picture = [&](uint32_t seed) { return renderGi(*scene, kCamera, settings, 20, kWidth, kHeight, seed); };
    const Picture first = picture(1);
    EXPECT_TRUE(equalBits(first, picture(1)));
    EXPECT_FALSE(equalBits(first, picture(2)));
}

/// In the first frame, which is filtered and reflects by harmonics, and after frames that gather at every pixel.
TEST_F(GiFrame, IsTheSumOfItsTermsUpToRounding)
{
    SceneBuilder builder;
    lamps(builder);
    builder.quad({-0.9f, 0.01f, 0.9f}, {1.8f, 0, 0}, {0, 0, -0.6f},
                 builder.material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0.8}}}}));
    const auto scene = load(room(builder));
    Settings settings = smallSettings();
    settings.gather_rays = 256;
    for (const uint32_t frames : {1u, 12u})
    {
        const auto pictureOf = [&](uint32_t term)
        {
            settings.term = term;
            return renderGi(*scene, kCamera, settings, frames, kWidth, kHeight).pixels;
        };
        const auto all = pictureOf(gpu::kTermAll);
        std::vector<Double3> sum(all.size());
        for (const uint32_t term :
             {gpu::kTermEmission, gpu::kTermDirect, gpu::kTermCaustics, gpu::kTermIndirect, gpu::kTermGlossy})
        {
            const auto part = pictureOf(term);
            double light = 0;
            for (size_t i = 0; i < all.size(); ++i)
            {
                sum[i] = sum[i] + Double3(part[i]);
                light += luminanceOf(part[i]);
            }
            EXPECT_GT(light, 0) << term;
        }
        // Nothing is negative: every addition errs by half a unit in the last place at most. A pixel gets up to eight shares of
        // light a frame, and frames add up.
        const double tolerance = 2 * (8 + frames) * 0x1p-24;
        for (size_t i = 0; i < all.size(); ++i)
            ASSERT_LE(largest(max(sum[i] - all[i], Double3(all[i]) - sum[i])), tolerance * largest(all[i]))
                << i << ", frames " << frames;
    }
}

struct Odd
{
    const char* name;
    std::function<void(SceneBuilder&)> build;
    Camera camera = kCamera;
};

void PrintTo(const Odd& value, std::ostream* out) // NOLINT: GoogleTest's name
{
    *out << value.name;
}

std::vector<Odd> oddScenes()
{
    const auto room = [](SceneBuilder& builder, const nlohmann::json& material) {
        builder.box({-1, 0, -1}, {1, 2, 1}, builder.material(material), true);
    };
    const auto lamp = [](SceneBuilder& builder) {
        builder.quad({-0.3f, 1.9f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, builder.material(emitter(8)));
    };
    Camera in_wall = kCamera;
    in_wall.position = {0, 1, 1};
    Camera below_floor = kCamera;
    below_floor.position = {0, 0.05f, 0.5f};
    return {{"WithoutLights", [=](SceneBuilder& builder) { room(builder, lambert(0.5)); }},
            {"WithoutDiffuseSurfaces",
             [=](SceneBuilder& builder)
             {
                 room(builder, mirror(0.9, 0.9, 0.9));
                 lamp(builder);
             }},
            {"OfRoughMetal",
             [=](SceneBuilder& builder)
             {
                 room(builder, with(mirror(0.9, 0.9, 0.9), {{"pbrMetallicRoughness", {{"roughnessFactor", 0.5}}}}));
                 lamp(builder);
             }},
            {"OfBlackSurfaces",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0));
                 lamp(builder);
             }},
            {"OfWhiteSurfaces",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(1));
                 lamp(builder);
             }},
            {"OfOneTriangleNearly", // a quad: the least that the builder makes
             [=](SceneBuilder& builder)
             {
                 builder.quad({-1, 0, 0}, {2, 0, 0}, {0, 2, 0}, builder.material(lambert(0.5)));
                 builder.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {0, 1, 1}}});
             }},
            {"OfNothingInView",
             [=](SceneBuilder& builder)
             {
                 builder.quad({5, 0, 5}, {1, 0, 0}, {0, 1, 0}, builder.material(lambert(0.5)));
                 builder.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {5.5, 0.5, 6}}});
             }},
            {"WithTheCameraInAWall",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 lamp(builder);
             },
             in_wall},
            {"WithTheCameraInABlock",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 builder.box({-0.5f, -0.1f, 0}, {0.5f, 0.2f, 0.9f}, builder.material(lambert(0.5)));
                 lamp(builder);
             },
             below_floor},
            {"WithTenThousandLights",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 const int glowing = builder.material(with(emitter(1), {{"doubleSided", true}}));
                 for (int i = 0; i < 50; ++i)
                     for (int k = 0; k < 100; ++k)
                         builder.quad({-0.9f + 1.8f * float(i) / 50, 1.9f, -0.9f + 1.8f * float(k) / 100},
                                      {0.01f, 0, 0}, {0, 0, 0.01f}, glowing);
             }},
            {"WithZeroAreaEmitters",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 const int glowing = builder.material(emitter(8));
                 builder.quad({0, 1, 0}, {0, 0, 0}, {0, 0, 0.5f}, glowing);
                 builder.quad({0.5f, 1, 0}, {0.2f, 0, 0}, {0.2f, 0, 0}, glowing);
                 builder.quad({0.2f, 1, 0}, {1e-20f, 0, 0}, {0, 0, 1e-20f}, glowing);
                 lamp(builder);
             }},
            {"WithZeroAreaEmittersOnly",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 builder.quad({0, 1, 0}, {0, 0, 0}, {0, 0, 0.5f}, builder.material(emitter(8)));
             }},
            {"WithLightsOnSurfaces",
             [=](SceneBuilder& builder)
             {
                 room(builder, lambert(0.5));
                 builder.sphere({0, 0.5f, 0}, 0.3f, 8, true, builder.material(mirror(1, 1, 1)));
                 for (const auto& at : {nlohmann::json{0, 0, 0}, {1, 2, 1}, {0, 0.5, 0}, {0, 2, 0}})
                     builder.light({{"type", "point"}, {"intensity", 3}}, {{"translation", at}});
             }},
            {"OfGreatSize", [=](SceneBuilder& builder)
             {
                 builder.floor(1e5f, 0, builder.material(lambert(0.5)));
                 lamp(builder);
                 builder.light({{"type", "directional"}, {"intensity", 3}}, {{"rotation", {-0.5, 0.5, 0.5, 0.5}}});
             }}};
}

class Odds : public GiFrame, public testing::WithParamInterface<Odd>
{
};

TEST_P(Odds, RenderWithoutHarm)
{
    SceneBuilder builder;
    GetParam().build(builder);
    const auto scene = load(builder.compile());
    Settings settings = smallSettings();
    settings.photon_count = 1000;
    settings.sample_count = 64;
    settings.gather_rays = 16;
    const Picture picture = renderGi(*scene, GetParam().camera, settings, 2, kWidth, kHeight); // expects finite samples
    double mean = 0;
    for (const gpu::vec3& pixel : picture.pixels)
    {
        EXPECT_TRUE(std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z));
        EXPECT_GE(std::min({pixel.x, pixel.y, pixel.z}), 0);
        mean += pixel.x / double(picture.pixels.size());
    }
    fmt::print("  {}: mean radiance {:.4g}\n", GetParam().name, mean);
}

INSTANTIATE_TEST_SUITE_P(, Odds, testing::ValuesIn(oddScenes()), [](const auto& odd) { return odd.param.name; });
} // namespace
