// Pictures of a moving scene at a time against those of a scene that was compiled as it is at that time.
#include "runtime/stages/pose.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/moving_scene.h"
#include "tools/compare/welch.h"

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 32, kSeeds = 6;

class PosedPictures : public GiTest, public testing::WithParamInterface<double>
{
protected:
    /// One picture a seed, of its first frame.
    std::vector<ImageF> pictures(const SceneGpu& scene, Mode mode)
    {
        const Camera camera{
            .name = {}, .position = {0, 1.6f, 4.5f}, .forward = {0, -0.2f, -0.98f}, .up = {0, 0.98f, -0.2f}};
        Settings settings = smallSettings();
        settings.direct_samples = 4;
        std::vector<ImageF> images;
        for (uint32_t seed = 0; seed < kSeeds; ++seed)
        {
            const uint32_t samples = mode == Mode::kReference ? 16 : 1;
            const Picture picture = render(scene, camera, settings, samples, kWidth, kHeight, mode, seed);
            images.push_back({kWidth, kHeight, {}});
            for (const gpu::vec3& pixel : picture.pixels)
                images.back().rgb.insert(images.back().rgb.end(), {pixel.x, pixel.y, pixel.z});
        }
        return images;
    }
};

TEST_P(PosedPictures, AreThoseOfTheSceneBakedAtThatTime)
{
    const MovingScene source;
    const auto package = package::Package::open(source.package());
    ASSERT_TRUE(package);
    const auto moving = load(source.package()), baked = load(source.bakedAt(GetParam()));
    PoseStage stage(device(), *moving, *package);
    for (const double seconds : {0.1, GetParam()}) // nothing of the pose before may be left
        submit(*moving, [&](Recorder& rec) { stage.record(rec, package::poseAt(*package, 0, seconds)); });
    for (const Mode mode : {Mode::kDirect, Mode::kReference, Mode::kGi})
    {
        const WelchResult result = welch(pictures(*moving, mode), pictures(*baked, mode));
        EXPECT_FALSE(result.differ()) << "mode " << int(mode) << ": p " << result.smallest.p << " of "
                                      << result.smallest.difference << " in tile " << result.smallest.tile_x << " "
                                      << result.smallest.tile_y;
    }
}

INSTANTIATE_TEST_SUITE_P(AtTimes, PosedPictures, testing::Values(0.6, 1.7));
} // namespace
