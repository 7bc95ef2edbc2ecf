// Legs of photons' paths: which of them are taken.
#include "runtime/stages/legs.h"
#include "tests/stages/gi_test.h"

namespace
{
class Legs : public GiTest
{
protected:
    std::vector<gpu::Leg> legsOf(const std::vector<gpu::Photon>& photons, uint32_t length)
    {
        SceneBuilder builder;
        builder.floor(1, 0, builder.material(lambert(0.5)));
        const auto scene = load(builder.compile());
        const Paths paths = pathsOf(photons, length);
        const LegsStage stage(device());
        submit(*scene, [&](Recorder& rec) { stage.record(rec, paths.output(), 1); });
        return contents<gpu::Leg>(stage.legs(), gpu::kLegCount);
    }
};

/// Photons of paths of three; the x of a position is its number.
std::vector<gpu::Photon> numbered(uint32_t path_count)
{
    std::vector<gpu::Photon> photons;
    for (uint32_t i = 0; i < 3 * path_count; ++i)
        photons.push_back({.position = {float(i), 0, 0},
                           .direction = packedNormal({1, 0, 0}),
                           .power = i % 3 == 0 ? gpu::vec3{1000, 1000, 1000} : gpu::vec3{1, 1, float(i % 7)},
                           .normal = packedNormal({-1, 0, 0})});
    return photons;
}

double luminanceOf(gpu::vec3 rgb)
{
    return 0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z;
}

TEST_F(Legs, LeadFromOnePhotonOfAPathToItsNextAndStandForAllOfTheirPower)
{
    const auto photons = numbered(gpu::kLegCount * gpu::kLegPaths); // no path is left out
    double power = 0, all = 0;
    for (const gpu::Leg& leg : legsOf(photons, 3))
    {
        const uint32_t to = uint32_t(leg.to.x);
        ASSERT_NE(to % 3, 0u); // from a light
        EXPECT_NEAR(leg.from.x, leg.to.x - 1, 1e-4);
        EXPECT_EQ(leg.normal, photons[to].normal);
        power += leg.power;
    }
    for (uint32_t i = 0; i < photons.size(); ++i)
        all += i % 3 == 0 ? 0 : luminanceOf(photons[i].power);
    EXPECT_NEAR(power, all, 1e-5 * all);
}

TEST_F(Legs, AreThereForFewPathsAndForNone)
{
    uint32_t found = 0;
    for (const gpu::Leg& leg : legsOf(numbered(5), 3))
        found += leg.power > 0;
    EXPECT_EQ(found, 5u);
    for (const auto& photons : {numbered(0), std::vector{numbered(1)[0]}}) // none; one that came from its light
        for (const gpu::Leg& leg : legsOf(photons, 1))
            EXPECT_EQ(leg.power, 0);
}
} // namespace
