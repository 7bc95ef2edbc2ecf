// The power of moving triangles that emit: of a pose alone, whatever a player has shown before.
#include "runtime/stages/emitter_shapes.h"
#include "tests/stages/sequence_folder.h"

#include "format/light_table.h"

namespace
{
class EmitterPowers : public SequenceFolder
{
};

/// Probabilities of a package's lights once it has shown these times of its first clip, one after the other.
std::vector<float> probabilitiesAfter(const package::Package& package, std::initializer_list<double> times)
{
    EmitterShapes shapes(package);
    package::LightTable table(package);
    LightChanges changes;
    for (const double seconds : times)
    {
        changes.restart(table.lights());
        shapes.change(package::poseAt(package, 0, seconds), changes);
        for (const auto& [index, light] : changes.changed())
            table.set(index, light);
        table.rebuild();
    }
    std::vector<float> probabilities;
    for (const gpu::Light& light : table.lights())
        probabilities.push_back(light.pmf);
    return probabilities;
}

TEST_F(EmitterPowers, AreThoseOfThePoseAlone)
{
    ASSERT_EQ(runProgram(LUMICUT_SCENES, quoted("") + " lamp").exit_code, 0);
    ASSERT_EQ(runProgram(LUMICUT_COMPILE, "-q " + quoted("lamp.glb")).exit_code, 0);
    const auto package = package::Package::open(folder_ / "lamp.lumi");
    ASSERT_TRUE(package) << package.error().message;
    for (const double seconds : {0.5, 13.0 / 24, 1.0, 1.375})
    {
        const auto alone = probabilitiesAfter(*package, {seconds});
        ASSERT_GT(alone.size(), 1u);
        EXPECT_EQ(probabilitiesAfter(*package, {0, seconds}), alone) << seconds;
        EXPECT_EQ(probabilitiesAfter(*package, {0, 0.25, 1.7, seconds}), alone) << seconds;
    }
}
} // namespace
