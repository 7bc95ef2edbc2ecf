// What is kept from frame to frame under a moving camera: what it is kept from, what ends it, and what it must not change.
#include "tests/stages/same_picture.h"
#include "tests/stages/shading_points.h"

#include <bit>
#include <cstring>
#include <map>
#include <set>

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

double variation(double alpha, Double3 x, Double3 n, Double3 center, Double3 normal)
{
    return alpha * length(x - center) + length(n - normal);
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
        Settings settings = reusing(true, true);
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

    static Settings reusing(bool photons, bool samples)
    {
        Settings settings = smallSettings();
        settings.reuse_photons = photons;
        settings.reuse_samples = samples;
        return settings;
    }

    SceneBuilder builder_;
    std::filesystem::path path_;
    std::unique_ptr<SceneGpu> scene_;
    uint32_t light_index_ = 0;
};

/// Samples of `now` that are those of `before` but for the pixel they are seen at.
uint32_t keptOf(const std::vector<gpu::Sample>& before, const std::vector<gpu::Sample>& now)
{
    const auto identity = [](gpu::Sample sample)
    {
        sample.pixel = 0;
        return std::string(reinterpret_cast<const char*>(&sample), sizeof(sample));
    };
    std::set<std::string> known;
    for (const gpu::Sample& sample : before)
        known.insert(identity(sample));
    return uint32_t(std::ranges::count_if(now, [&](const gpu::Sample& s) { return known.contains(identity(s)); }));
}

TEST_F(Reuse, LeftOutMakesEveryFrameANewOne)
{
    const Settings off = reusing(false, false);
    expectFresh({{movedBy(-0.05f), off}, {movedBy(-0.02f), off}, {kCamera, off}}, "three cameras");
}

TEST_F(Reuse, OfPhotonsChangesNothing)
{
    const Settings photons = reusing(true, false);
    // Kept photons are sorted, and nodes measured, as seen from where they were made: the picture is another estimate of the same.
    std::vector<ImageF> kept, anew_at_once;
    for (uint32_t seed = 1; seed <= 6; ++seed)
    {
        kept.push_back(imageOf(kWidth, kHeight, play({{movedBy(-0.05f), photons, seed}, {kCamera, photons, seed}}).back().pixels));
        anew_at_once.push_back(imageOf(kWidth, kHeight, play({{kCamera, photons, seed + 100}}).back().pixels));
    }
    expectSamePicture("photons that are kept", kept, anew_at_once, 0.05);
    const auto standing = play({{kCamera, photons}, {kCamera, photons}, {kCamera, photons}}),
               anew = play({{kCamera, reusing(false, false)}, {kCamera, reusing(false, false)}, {kCamera, reusing(false, false)}});
    EXPECT_TRUE(equalBits(standing.back().pixels, anew.back().pixels)) << "a standing picture";
    Settings fewer = photons;
    fewer.photon_count /= 2;
    expectFresh({{movedBy(-0.05f), photons}, {kCamera, fewer}}, "other settings");
    expectFresh({{movedBy(-0.05f), photons, 1}, {kCamera, photons, 2}}, "another seed");
}

TEST_F(Reuse, OfSamplesEndsWithLightsSettingsSeedAndStandingPictures)
{
    const Settings on = reusing(false, true); // kept photons would make another estimate of the same
    gpu::Light brighter = pointLight();
    brighter.emission = 4.0f * brighter.emission;
    expectFresh({{movedBy(-0.05f), on}, {kCamera, on, 0, brighter}}, "a light that changes");
    Settings others = on;
    others.gather_rays = 16;
    expectFresh({{movedBy(-0.05f), on}, {kCamera, others}}, "other settings");
    expectFresh({{movedBy(-0.05f), on, 1}, {kCamera, on, 2}}, "another seed");
    expectFresh({{movedBy(-0.05f), on}, {movedBy(-0.05f), on}, {kCamera, on}}, "a standing picture");
    Settings off = reusing(false, false);
    expectFresh({{movedBy(-0.05f), on}, {kCamera, off}}, "reuse turned off");
}

TEST_F(Reuse, LightChangeAloneStartsThePictureAnew)
{
    gpu::Light brighter = pointLight();
    brighter.emission = 4.0f * brighter.emission;
    expectFresh({{kCamera}, {kCamera}, {kCamera, reusing(true, true), 0, brighter}}, "a light that changes over a standing camera");
}

TEST_F(Reuse, KeepsNearlyAllSamplesOverATinyStep)
{
    const auto shown = play({{kCamera}, {movedBy(1e-4f)}});
    const uint32_t before = uint32_t(shown[0].samples.size()), kept = keptOf(shown[0].samples, shown[1].samples);
    fmt::print("  {} of {} samples kept, {} in all\n", kept, before, shown[1].samples.size());
    EXPECT_GE(kept, before * 9 / 10); // one in kSampleFrames has to go
    EXPECT_LT(kept, shown[1].samples.size());
    EXPECT_LE(shown[1].samples.size(), smallSettings().sample_count);
}

TEST_F(Reuse, NeverSpendsMoreThanTheBudgetAndKeepsMostOfIt)
{
    const auto travel = [&](bool reuse)
    {
        std::vector<Frame> frames;
        for (int i = 0; i < 40; ++i) // to the side, back, and back again: walls come into view and leave it
            frames.push_back({movedBy(0.01f * float(i), i < 20 ? -0.02f * float(i) : -0.4f + 0.02f * float(i - 20)), reusing(true, reuse)});
        return play(frames);
    };
    const auto frames = travel(true), anew = travel(false);
    double kept = 0, mean = 0, reference = 0;
    size_t least = ~size_t(0);
    for (size_t i = 1; i < frames.size(); ++i)
    {
        EXPECT_LE(frames[i].samples.size(), smallSettings().sample_count);
        least = std::min(least, frames[i].samples.size());
        kept += double(keptOf(frames[i - 1].samples, frames[i].samples)) / double(frames[i - 1].samples.size()) / double(frames.size() - 1);
    }
    for (size_t i = 0; i < frames.back().pixels.size(); ++i)
    {
        mean += frames.back().pixels[i].x;
        reference += anew.back().pixels[i].x;
    }
    fmt::print("  {:.1f} % of the samples are kept a frame, at least {} samples; the last frame is {:.4f} of a new one\n", 100 * kept, least,
               mean / reference);
    EXPECT_GT(kept, 0.5);
    EXPECT_GE(least, smallSettings().sample_count * 3 / 4); // clusters that lose all their points are dropped
    EXPECT_TRUE(equalBits(frames.back().pixels, travel(true).back().pixels)) << "equal input, equal bits";
}

/// The stage on its own, its samples given known light, against a slow twin.
class ReuseStage : public Reuse
{
protected:
    void SetUp() override
    {
        Reuse::SetUp();
        before_.emplace(device(), *scene_, path_, movedBy(-0.1f), kWidth, kHeight);
        now_.emplace(device(), *scene_, path_, kCamera, kWidth, kHeight);
        stage_.emplace(device(), kWidth, kHeight, kBudget);
        ASSERT_EQ(stage_->stride(), 1u);
    }

    std::vector<gpu::Sample> record(const ShadingPoints& points, uint32_t age, uint32_t budget = kBudget)
    {
        const RayStage rays(device(), *scene_);
        std::optional<SamplesStage::Output> out;
        submit(*scene_,
               [&](Recorder& rec)
               {
                   out.emplace(stage_->record(rec, rays,
                                              {.diffuse_points = points.gpu->diffuse_points,
                                               .mode = SamplesMode::kKmeans,
                                               .budget = budget,
                                               .iterations = 2,
                                               .alpha = float(kAlpha * diagonalOf(*scene_)),
                                               .reach = 5,
                                               .seed = 3,
                                               .age = age}));
               });
        kept_ = countOf(out->kept);
        return contents<gpu::Sample>(out->samples, countOf(out->size));
    }

    /// Gives the stage's samples a light of their own, as gathering would.
    std::vector<gpu::Sample> lit(std::vector<gpu::Sample> samples)
    {
        for (size_t i = 0; i < samples.size(); ++i)
        {
            samples[i].irradiance = {float(i), 1, 2};
            samples[i].harmonic = 0.5f + float(i);
        }
        const Buffer on_gpu = upload("test.lit", samples);
        submit(*scene_, [&](Recorder& rec)
               { rec.copy(on_gpu, stage_->output().samples, samples.size() * sizeof(gpu::Sample)); });
        return samples;
    }
    std::vector<gpu::SampleTenure> tenures(size_t count)
    {
        return contents<gpu::SampleTenure>(stage_->tenures(), uint32_t(count));
    }
    static double eps(const ShadingPoints::Point& p, const gpu::Sample& sample)
    {
        return variation(kAlpha, p.position, p.normal, sample.position, unpackedNormal(sample.normal));
    }
    static bool takesPart(const ShadingPoints::Point& p) { return p.exists && p.diffuse.x > 0; }

    static constexpr uint32_t kBudget = 128;
    static constexpr double kAlpha = 5;    // per metre
    static constexpr double kTie = 2e-4;   // of eps: normals have 16 bits an axis
    std::optional<ShadingPoints> before_, now_;
    std::optional<SamplesStage> stage_;
    uint32_t kept_ = 0;
};

uint32_t zOrder(uint32_t x, uint32_t y)
{
    uint32_t index = 0;
    for (int bit = 15; bit >= 0; --bit)
        index = index << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
    return index;
}

TEST_F(ReuseStage, TenureReachesAsFarAsTheClusterAndEndsOneByOne)
{
    const auto samples = record(*before_, 0);
    EXPECT_EQ(kept_, 0u);
    const auto held = tenures(samples.size());
    const auto quadtree = stage_->quadtree();
    const auto owners = contents<gpu::uvec2>(quadtree.owners, uint32_t(quadtree.owners.size() / sizeof(gpu::uvec2)));
    const auto ownerOf = [&](uint32_t pixel) { return owners[zOrder(pixel % kWidth, pixel / kWidth)].x; };
    std::map<uint32_t, size_t> sample_of; // by cluster
    for (size_t i = 0; i < samples.size(); ++i)
        sample_of[ownerOf(samples[i].pixel)] = i;
    std::vector<double> greatest(samples.size());
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
        if (takesPart(before_->points[pixel]))
        {
            const size_t i = sample_of.at(ownerOf(pixel));
            greatest[i] = std::max(greatest[i], eps(before_->points[pixel], samples[i]));
        }
    std::set<uint32_t> ends;
    for (size_t i = 0; i < samples.size(); ++i)
    {
        EXPECT_NEAR(held[i].greatest_eps, std::max(greatest[i], kAlpha * 1e-3 * diagonalOf(*scene_)), kTie);
        EXPECT_GE(held[i].frames_left, 1u);
        EXPECT_LE(held[i].frames_left, gpu::kSampleFrames);
        ends.insert(held[i].frames_left);
    }
    EXPECT_GT(ends.size(), gpu::kSampleFrames / 2);
}

TEST_F(ReuseStage, KeepsWhatItsTwinKeeps)
{
    const auto old = lit(record(*before_, 0));
    const auto held = tenures(old.size());
    // Who owns a point of the new picture, surely or by less than rounding.
    std::vector<uint32_t> sure(old.size()), perhaps(old.size());
    uint32_t point_count = 0, claimed = 0;
    std::map<uint32_t, uint32_t> owner_of; // by pixel
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    {
        const ShadingPoints::Point& p = now_->points[pixel];
        if (!takesPart(p))
            continue;
        ++point_count;
        size_t owner = 0;
        for (size_t i = 0; i < old.size(); ++i)
            if (eps(p, old[i]) < eps(p, old[owner]))
                owner = i;
        for (size_t i = 0; i < old.size(); ++i)
            if (eps(p, old[i]) <= eps(p, old[owner]) + kTie && eps(p, old[i]) <= held[i].greatest_eps + kTie)
                ++perhaps[i];
        if (eps(p, old[owner]) > held[owner].greatest_eps)
            continue;
        ++claimed;
        ++sure[owner];
        owner_of[pixel] = uint32_t(owner);
    }
    const auto samples = record(*now_, 1);
    ASSERT_LE(samples.size(), kBudget);
    ASSERT_LE(kept_, samples.size());
    const double unclaimed = 1 - double(claimed) / point_count;
    fmt::print("  {} of {} points claimed; {} of {} samples kept, {} new\n", claimed, point_count, kept_, old.size(),
               samples.size() - kept_);
    EXPECT_LE(kept_, kBudget - uint32_t(std::floor((unclaimed - 0.002) * kBudget)));
    EXPECT_GT(kept_, old.size() / 2);

    std::map<float, size_t> by_light; // what lit() gave them tells them apart
    for (size_t i = 0; i < old.size(); ++i)
        by_light[old[i].irradiance.x] = i;
    std::set<size_t> kept;
    uint32_t least_kept = ~0u;
    for (uint32_t k = 0; k < kept_; ++k)
    {
        const size_t i = by_light.at(samples[k].irradiance.x);
        EXPECT_TRUE(kept.insert(i).second);
        gpu::Sample expected = old[i];
        expected.pixel = samples[k].pixel;
        EXPECT_EQ(std::memcmp(&expected, &samples[k], sizeof(expected)), 0);
        EXPECT_TRUE(takesPart(now_->points[samples[k].pixel]));
        EXPECT_LE(eps(now_->points[samples[k].pixel], old[i]), held[i].greatest_eps + kTie);
        EXPECT_GT(perhaps[i], 0u);
        least_kept = std::min(least_kept, held[i].frames_left);
    }
    const auto kept_tenures = tenures(samples.size());
    for (uint32_t k = 0; k < kept_; ++k)
    {
        const size_t i = by_light.at(samples[k].irradiance.x);
        EXPECT_EQ(kept_tenures[k].greatest_eps, held[i].greatest_eps);
        EXPECT_EQ(kept_tenures[k].frames_left, held[i].frames_left - 1);
    }
    for (size_t i = 0; i < old.size(); ++i)
        if (sure[i] > 0 && !kept.contains(i))
        {
            EXPECT_LT(held[i].frames_left, least_kept) << "one that owns a point and had more time went first";
        }
    for (uint32_t k = kept_; k < samples.size(); ++k) // new ones: at points that nobody who is kept had nearer
    {
        EXPECT_EQ(samples[k].irradiance.y, 0);
        EXPECT_TRUE(takesPart(now_->points[samples[k].pixel]));
    }
}

TEST_F(ReuseStage, EveryPointHasTheNearestOwner)
{
    const auto old = lit(record(*before_, 0));
    const auto samples = record(*now_, 1);
    const auto quadtree = stage_->quadtree();
    const auto owners = contents<gpu::uvec2>(quadtree.owners, uint32_t(quadtree.owners.size() / sizeof(gpu::uvec2)));
    std::set<uint32_t> clusters;
    uint32_t kept_points = 0;
    for (uint32_t pixel = 0; pixel < kWidth * kHeight; ++pixel)
    {
        const ShadingPoints::Point& p = now_->points[pixel];
        const gpu::uvec2 owner = owners[zOrder(pixel % kWidth, pixel / kWidth)];
        EXPECT_EQ(owner.x == gpu::kNone, !takesPart(p));
        if (owner.x == gpu::kNone)
            continue;
        const float stored = std::bit_cast<float>(owner.y);
        if (owner.x >= gpu::kKeptBit)
        {
            ++kept_points;
            EXPECT_NEAR(stored, eps(p, old.at(owner.x & ~gpu::kKeptBit)), kTie);
        }
        else
            clusters.insert(owner.x);
    }
    EXPECT_EQ(clusters.size(), samples.size() - kept_);
    EXPECT_GT(kept_points, kWidth * kHeight / 2);
}

TEST_F(ReuseStage, GivesANewViewItsShareOfTheBudget)
{
    (void)lit(record(*before_, 0));
    Camera turned = kCamera; // towards what was behind the camera
    turned.position = {0, 1, -0.95f};
    turned.forward = {0, 0, 1};
    const ShadingPoints behind(device(), *scene_, path_, turned, kWidth, kHeight);
    const auto samples = record(behind, 1);
    fmt::print("  {} kept, {} new\n", kept_, samples.size() - kept_);
    EXPECT_GE(samples.size(), kBudget * 9 / 10);
    EXPECT_LT(kept_, samples.size() / 2);
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
            sample->irradiance = {}, sample->harmonic = 0;
    }
    EXPECT_TRUE(equalBits(free, kept));
    EXPECT_GT(relit, free.size() / 2);
}
} // namespace
