// What is kept from frame to frame under a moving camera, what ends it, and what it must not change.
#include "tests/stages/gi_test.h"
#include "tests/stages/same_picture.h"

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

Camera movedBy(float right, float back = 0)
{
    Camera moved = kCamera;
    moved.position = kCamera.position + gpu::vec3{right, 0, back};
    return moved;
}

template <typename T>
bool equalBits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// A room with a lamp, a point light, a mirror and a glossy ball.
std::filesystem::path room(SceneBuilder& scene)
{
    scene.box({-1, 0, -1}, {1, 2, 1}, scene.material(lambert(0.6)), true);
    scene.quad({-0.3f, 1.99f, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, scene.material(emitter(8)));
    scene.sphere({-0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(mirror(0.9, 0.6, 0.3)));
    scene.sphere({0.5f, 0.4f, -0.3f}, 0.3f, 12, true, scene.material(lambert(0.4)));
    scene.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {0.6, 1.5, 0.3}}});
    return scene.compile();
}

class Reuse : public GiTest
{
protected:
    void SetUp() override
    {
        GiTest::SetUp();
        path_ = room(builder_);
        scene_ = load(path_);
    }

    struct Frame
    {
        Camera camera;
        Settings settings = reusing(true);
        uint32_t seed = 0;
        std::optional<gpu::Light> light; // that light 0 becomes before it
    };
    struct Shown
    {
        std::vector<gpu::vec3> pixels;
        std::vector<gpu::Sample> samples;
    };
    /// One renderer's frames, one after the other.
    std::vector<Shown> play(const std::vector<Frame>& frames)
    {
        Renderer renderer(device(), *scene_, Mode::kGi, kWidth, kHeight, smallSettings());
        Recorder rec(device());
        std::vector<Shown> shown;
        for (const Frame& frame : frames)
        {
            rec.begin(scene_->descriptorSet());
            if (frame.light)
                scene_->setLight(rec, light_index_, *frame.light);
            renderer.record(rec, frame.camera, frame.settings, frame.seed);
            rec.submitAndWait();
            EXPECT_EQ(renderer.nonFiniteCount(device()), 0u);
            shown.push_back({renderer.picture(device()), renderer.irradianceSamples(device())});
        }
        return shown;
    }
    /// The last of `frames` is the picture that a renderer without a past makes.
    void expectFresh(const std::vector<Frame>& frames, const char* what)
    {
        const Shown last = play(frames).back(), fresh = play({frames.back()}).back();
        EXPECT_TRUE(equalBits(last.pixels, fresh.pixels)) << what;
        EXPECT_TRUE(equalBits(last.samples, fresh.samples)) << what;
    }

    gpu::Light pointLight()
    {
        const auto package = package::Package::open(path_);
        for (light_index_ = 0; package->lights()[light_index_].kind != gpu::kLightPoint; ++light_index_)
            ;
        return package->lights()[light_index_];
    }

    static Settings reusing(bool photons)
    {
        Settings settings = smallSettings();
        settings.reuse_photons = photons;
        settings.history_frames = settings.antialias_frames = 0; // what frames share beside light itself
        return settings;
    }

    SceneBuilder builder_;
    std::filesystem::path path_;
    std::unique_ptr<SceneGpu> scene_;
    uint32_t light_index_ = 0;
};

TEST_F(Reuse, LeftOutMakesEveryFrameANewOne)
{
    const Settings off = reusing(false);
    expectFresh({{movedBy(-0.05f), off}, {movedBy(-0.02f), off}, {kCamera, off}}, "three cameras");
}

TEST_F(Reuse, OfPhotonsChangesNothing)
{
    const Settings photons = reusing(true);
    // Kept photons are sorted, and nodes measured, as seen from where they were made: the picture is another estimate of the same.
    std::vector<ImageF> kept, anew_at_once;
    for (uint32_t seed = 1; seed <= 6; ++seed)
    {
        kept.push_back(
            imageOf(kWidth, kHeight, play({{movedBy(-0.05f), photons, seed}, {kCamera, photons, seed}}).back().pixels));
        anew_at_once.push_back(imageOf(kWidth, kHeight, play({{kCamera, photons, seed + 100}}).back().pixels));
    }
    expectSamePicture("photons that are kept", kept, anew_at_once, 0.05);
    const auto standing = play({{kCamera, photons}, {kCamera, photons}, {kCamera, photons}}),
               anew = play({{kCamera, reusing(false)}, {kCamera, reusing(false)}, {kCamera, reusing(false)}});
    EXPECT_TRUE(equalBits(standing.back().pixels, anew.back().pixels)) << "a static view";
    Settings fewer = photons;
    fewer.photon_count /= 2;
    expectFresh({{movedBy(-0.05f), photons}, {kCamera, fewer}}, "other settings");
    expectFresh({{movedBy(-0.05f), photons, 1}, {kCamera, photons, 2}}, "another seed");
}

TEST_F(Reuse, LightChangeAloneStartsThePictureAnew)
{
    gpu::Light brighter = pointLight();
    brighter.emission = 4.0f * brighter.emission;
    expectFresh({{kCamera}, {kCamera}, {kCamera, reusing(true), 0, brighter}},
                "a light that changes over a standing camera");
}

TEST_F(Reuse, PlacementSeedKeepsSamplesWhereTheyAreUnderOtherSeeds)
{
    Renderer renderer(device(), *scene_, Mode::kGi, kWidth, kHeight, smallSettings());
    Recorder rec(device());
    const auto samples = [&](uint32_t seed)
    {
        rec.begin(scene_->descriptorSet());
        renderer.restart();
        renderer.record(rec, kCamera, smallSettings(), seed);
        rec.submitAndWait();
        return renderer.irradianceSamples(device());
    };
    std::vector<gpu::Sample> free = samples(3);
    renderer.placeSamplesBy(3);
    EXPECT_GT(renderer.cutNodeCount(device()), 0u);
    std::vector<gpu::Sample> kept = samples(4);
    ASSERT_EQ(free.size(), kept.size());
    uint32_t relit = 0;
    for (size_t i = 0; i < free.size(); ++i)
    {
        relit += free[i].irradiance.x != kept[i].irradiance.x;
        for (gpu::Sample* sample : {&free[i], &kept[i]}) // what is gathered
            sample->irradiance = {}, sample->harmonic_mean_distance = 0;
    }
    EXPECT_TRUE(equalBits(free, kept));
    EXPECT_GT(relit, free.size() / 2);
}
} // namespace
