// What pixels remember while the picture moves, against the mean of what their surface showed, and where they must forget.
#include "runtime/frame/plan.h"
#include "runtime/stages/antialias.h"
#include "runtime/stages/history.h"
#include "shaders/lib/terms.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <algorithm>
#include <numeric>

namespace
{
constexpr uint32_t kWidth = 42, kHeight = 26, kPixels = kWidth * kHeight; // no whole number of tiles

// Rounding: of a memory's mantissas, once a frame, and of a signal's light and reflectance, packed and unpacked twice.
constexpr double kMantissa = 1.0 / 16383, kSignal = 2 * (3 * 0.5 / 4095 + 0x1p-11);

class History : public GiTest
{
protected:
    void load()
    {
        path_ = builder_.compile();
        scene_ = GiTest::load(path_);
        signals_.emplace(device(), *scene_, kPixels);
        history_.emplace(device(), scene_->constants(), kWidth, kHeight);
        primary_.emplace(device(), *scene_, kPixels);
        light_.emplace(device(), kPixels, true);
    }

    /// One frame of a camera that looks through the pixels' centres, with this direct light in all pixels.
    void show(const Camera& camera, gpu::vec3 direct, uint32_t most_frames = 32)
    {
        show(camera, std::vector<gpu::vec3>(kPixels, direct), std::nullopt, most_frames);
    }
    void show(const Camera& camera, const std::vector<gpu::vec3>& direct, std::optional<LightRange> light_range,
              uint32_t most_frames = 32)
    {
        FrameInfo frame{.camera = cameraParams(camera, kWidth, kHeight), .previous = last_, .number = number_++};
        frame.camera.jitter = {0.5f, 0.5f};
        if (last_)
            frame.light_range = light_range;
        const Buffer input = upload("test.light", direct);
        const RayStage rays(device(), *scene_);
        submit(*scene_,
               [&](Recorder& rec)
               {
                   light_->clear(rec, gpu::kLightIndirect | gpu::kLightCaustics);
                   rec.copy(input, light_->direct, kPixels * sizeof(gpu::vec3));
                   surface_.emplace(primary_->record(
                       rec, rays, {.camera = frame.camera, .specular_depth = 2, .emission = light_->emission}));
                   buffers_.emplace(signals_->record(rec, frame, *surface_, *light_, gpu::kLightDirect));
                   history_->record(rec, {.signals = *buffers_,
                                          .surface = *surface_,
                                          .light = *light_,
                                          .frame = frame,
                                          .most_frames = most_frames});
                   signals_->apply(rec, buffers_->direct, buffers_->direct, light_->direct, kPixels);
               });
        last_ = frame.camera;
    }
    std::vector<gpu::vec3> direct() { return contents<gpu::vec3>(light_->direct, kPixels); }
    std::vector<gpu::ShadingPoint> points() { return contents<gpu::ShadingPoint>(surface_->points, kPixels); }

    SceneBuilder builder_;
    std::filesystem::path path_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<SignalsStage> signals_;
    std::optional<HistoryStage> history_;
    std::optional<PrimaryStage> primary_;
    std::optional<LightBuffers> light_;
    std::optional<SurfaceBuffers> surface_;
    std::optional<SignalBuffers> buffers_;
    std::optional<gpu::CameraParams> last_;
    uint32_t number_ = 0;
};

/// A wall, one pixel a metre, and a camera that goes three pixels to the right a frame: light is the mean since a pixel's part of
/// the wall came into view.
TEST_F(History, IsTheMeanOfWhatTheSurfaceShowedSinceItCameIntoView)
{
    builder_.quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, builder_.material(lambert(0.5)));
    load();
    Camera camera{.name = "",
                  .position = {0, 0, 5},
                  .forward = {0, 0, -1},
                  .up = {0, 1, 0},
                  .vertical_fov = 0,
                  .orthographic_height = kHeight};
    const std::vector<double> shown{4, 1, 3, 0, 8, 2, 5};
    for (size_t t = 0; t < shown.size(); ++t, camera.position.x += 3)
    {
        show(camera, {float(shown[t]), float(shown[t]) / 2, float(shown[t]) / 4});
        const auto got = direct();
        for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        {
            const size_t in_view = (kWidth - 1 - pixel % kWidth) / 3, since = t - std::min(t, in_view);
            const double mean =
                std::accumulate(shown.begin() + ptrdiff_t(since), shown.begin() + ptrdiff_t(t) + 1, 0.0) /
                double(t + 1 - since);
            const double tolerance = 8 * (double(t + 1) * kMantissa + kSignal);
            ASSERT_NEAR(got[pixel].x, mean, tolerance) << t << ", " << pixel % kWidth;
            ASSERT_NEAR(got[pixel].z, mean / 4, tolerance);
        }
    }
}

TEST_F(History, LightThatIsEvenStaysWhatItIsForHundredsOfFrames)
{
    builder_.quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, builder_.material(lambert(0.5)));
    load();
    const Camera camera{.name = "",
                        .position = {0, 0, 5},
                        .forward = {0, 0, -1},
                        .up = {0, 1, 0},
                        .vertical_fov = 0,
                        .orthographic_height = kHeight};
    for (int t = 0; t < 200; ++t)
        show(camera, {0.7f, 0.11f, 0.013f});
    double sum = 0;
    for (const gpu::vec3 light : direct())
    {
        sum += light.z;
        EXPECT_NEAR(light.x, 0.7,
                    0.7 * (34 * kMantissa + kSignal)); // what is older than 33 frames has next to no weight
    }
    // Rounding goes up and down by chance: in the mean over the pixels, whose errors are independent, it leaves a part of sqrt(pixels).
    EXPECT_NEAR(sum / kPixels, 0.013,
                5 * 0.7 * 34 * kMantissa / std::sqrt(double(kPixels)) + 0.013 * kSignal + 0.7 * 0.5 / 4095);
}

/// Light goes on where all of the four pixels that it is taken from saw the same quad, and starts anew where none did.
TEST_F(History, GoesOnOnTheSameSurfaceAndStartsAnewWhereAnotherHidIt)
{
    builder_.quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, builder_.material(lambert(0.5)));
    builder_.quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, builder_.material(lambert(0.25)));
    load();
    Camera camera{.name = "", .position = {0, 0, 6}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .vertical_fov = 0.9f};
    show(camera, {1, 1, 1});
    const auto before = points();
    camera.position.x = 0.3f;
    show(camera, {3, 3, 3});
    const auto now = points();
    const auto motions = contents<gpu::Motion>(buffers_->motions, kPixels);
    const auto got = direct();
    uint32_t went_on = 0, anew = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        // Where the point was: the old camera was 0.3 to the left.
        const gpu::vec3 p = now[pixel].position;
        const double half = std::tan(0.45), aspect = double(kWidth) / kHeight, depth = 6 - p.z;
        const double x = (p.x / (depth * half * aspect) + 1) / 2 * kWidth - 0.5,
                     y = (1 - p.y / (depth * half)) / 2 * kHeight - 0.5;
        ASSERT_NEAR(pixel % kWidth + motions[pixel].from.x, x, 1e-3);
        ASSERT_NEAR(pixel / kWidth + motions[pixel].from.y, y, 1e-3);
        ASSERT_NEAR(motions[pixel].distance, std::hypot(p.x - 0.3, p.y, depth), 1e-4);
        uint32_t same = 0, other = 0;
        for (const int step : {0, 1, 2, 3})
        {
            const double column = std::floor(x) + (step & 1), row = std::floor(y + 1e-3) + (step >> 1);
            if (column < 0 || column >= kWidth || row < 0 || row >= kHeight)
                continue;
            const gpu::ShadingPoint& old = before[size_t(row) * kWidth + size_t(column)];
            ++(std::abs(old.position.z - p.z) < 1 ? same : other);
        }
        if (other == 0 && same > 0)
        {
            ++went_on;
            EXPECT_NEAR(got[pixel].x, 2, 4 * (2 * kMantissa + kSignal)) << pixel;
        }
        else if (same == 0)
        {
            ++anew;
            EXPECT_NEAR(got[pixel].x, 3, 4 * kSignal) << pixel;
        }
    }
    fmt::print("  {} pixels went on, {} started anew\n", went_on, anew);
    EXPECT_GT(went_on, kPixels * 3 / 4);
    EXPECT_GT(anew, 10u);
}

/// A wall that fills the picture, looked at by a camera that stands still: every pixel goes on from itself.
class ChangedLight : public History
{
protected:
    void SetUp() override
    {
        History::SetUp();
        builder_.quad({-500, -500, 0}, {1000, 0, 0}, {0, 1000, 0}, builder_.material(lambert(0.5)));
        load();
    }
    /// Grey light of that mean, each pixel between 0.5 and 1.5 times as much.
    std::vector<gpu::vec3> noisy(float mean)
    {
        std::vector<gpu::vec3> light(kPixels);
        for (gpu::vec3& pixel : light)
        {
            const float grey = mean * random_.between(0.5f, 1.5f);
            pixel = {grey, grey, grey};
        }
        return light;
    }
    void showFrames(uint32_t count, float mean)
    {
        for (uint32_t t = 0; t < count; ++t)
            show(camera_, noisy(mean), std::nullopt);
    }
    /// Of green over the pixels: mean and standard deviation.
    std::pair<double, double> shown()
    {
        double sum = 0, squares = 0;
        for (const gpu::vec3 pixel : direct())
        {
            sum += pixel.y;
            squares += double(pixel.y) * pixel.y;
        }
        const double mean = sum / kPixels;
        return {mean, std::sqrt(std::max(squares / kPixels - mean * mean, 0.0))};
    }

    static constexpr double kNoise = 0.2886751345948129; // of noisy(1): its standard deviation
    const Camera camera_{.name = "",
                         .position = {0, 0, 5},
                         .forward = {0, 0, -1},
                         .up = {0, 1, 0},
                         .vertical_fov = 0,
                         .orthographic_height = kHeight};
    Random random_{17};
};

TEST_F(ChangedLight, OfLightsThatAreAllOffNothingIsLeft)
{
    showFrames(8, 3);
    show(camera_, std::vector<gpu::vec3>(kPixels), LightRange{});
    for (const gpu::vec3 pixel : direct())
        ASSERT_EQ(pixel.x + pixel.y + pixel.z, 0);
}

/// Nothing is known of the change, but all pixels show it.
TEST_F(ChangedLight, OfALightThatIsOffNextToNothingIsLeft)
{
    showFrames(8, 3);
    show(camera_, std::vector<gpu::vec3>(kPixels), LightRange::anything());
    EXPECT_LT(shown().first, 0.01 * 3);
    for (int t = 0; t < 3; ++t)
        show(camera_, std::vector<gpu::vec3>(kPixels), LightRange::anything());
    EXPECT_LT(shown().first, 0.001 * 3);
}

TEST_F(ChangedLight, WithoutAChangeTheHistoryIsAsIfNoneHadBeenAsked)
{
    std::array<std::vector<gpu::vec3>, 2> last;
    for (std::vector<gpu::vec3>& got : last)
    {
        random_ = Random(17);
        last_.reset();
        number_ = 0;
        showFrames(6, 1);
        show(camera_, noisy(3), &got == &last[0] ? std::nullopt : std::optional(LightRange{{1, 1, 1}, {1, 1, 1}}));
        got = direct();
    }
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        ASSERT_EQ(last[0][pixel].x, last[1][pixel].x);
}

TEST_F(ChangedLight, KnownFactorMultipliesTheHistory)
{
    showFrames(16, 1);
    const auto before = direct();
    const std::vector<gpu::vec3> now = noisy(2);
    show(camera_, now, LightRange{{2, 2, 2}, {2, 2, 2}});
    const auto got = direct();
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        ASSERT_NEAR(got[pixel].x, (16 * 2 * before[pixel].x + now[pixel].x) / 17, 8 * (2 * kMantissa + kSignal));
}

/// Where the surroundings differ by no more than chance, the pixels keep what they know. All pixels together have the mean of
/// what was shown, which the change of 1 % and five standard errors bound.
TEST_F(ChangedLight, SmallChangeKeepsMostOfTheHistory)
{
    showFrames(16, 1);
    show(camera_, noisy(1.01f), LightRange::anything());
    const auto [mean, deviation] = shown();
    EXPECT_NEAR(mean, 1, 0.01 + 5 * kNoise / std::sqrt(double(kPixels)));
    EXPECT_LT(deviation, kNoise / std::sqrt(8.0)) << "half of 16 frames";
}

/// Light that doubles: the mean follows at once, and the surroundings' mean is far less noisy than a frame.
TEST_F(ChangedLight, LargeChangeIsFollowedAtOnce)
{
    showFrames(16, 1);
    show(camera_, noisy(2), LightRange::anything());
    const auto [mean, deviation] = shown();
    EXPECT_NEAR(mean, 2, 0.05);
    EXPECT_LT(deviation, 2 * kNoise / 2) << "of a single frame the half";
}

/// Rays that seldom find a bright light: once it is known how seldom, frames in which they do not are no darkness.
TEST_F(ChangedLight, RareBrightSamplesKeepTheirMean)
{
    constexpr uint32_t kOneIn = 32, kFrames = 40;
    const auto sparks = [&]
    {
        std::vector<gpu::vec3> light(kPixels);
        for (gpu::vec3& pixel : light)
            if (random_.below(kOneIn) == 0)
                pixel = {kOneIn, kOneIn, kOneIn};
        return light;
    };
    for (uint32_t t = 0; t < kFrames; ++t)
        show(camera_, sparks(), std::nullopt, gpu::kMostHistoryFrames);
    for (uint32_t t = 0; t < 4; ++t)
        show(camera_, sparks(), LightRange::anything(), gpu::kMostHistoryFrames);
    // Five standard errors of the mean over the pixels, of as much as a third of the frames.
    EXPECT_NEAR(shown().first, 1, 5 * std::sqrt((kOneIn - 1.0) / (kFrames / 3.0 * kPixels)));
}

TEST_F(ChangedLight, EvenLightIsWhatItIsNow)
{
    for (int t = 0; t < 6; ++t)
        show(camera_, {1, 0.5f, 0.25f});
    for (const gpu::vec3 now : {gpu::vec3{0.25f, 0.5f, 1}, gpu::vec3{4, 4, 4}, gpu::vec3{0, 1, 0}})
    {
        show(camera_, std::vector<gpu::vec3>(kPixels, now), LightRange::anything());
        for (const gpu::vec3 pixel : direct())
        {
            // Means are compared in 8 bits.
            ASSERT_NEAR(pixel.x, now.x, 4.0 / 255 + 8 * kSignal);
            ASSERT_NEAR(pixel.z, now.z, 4.0 / 255 + 8 * kSignal);
        }
    }
}

TEST(LightRange, IsThatOfTheFactorsOfAllThatEmits)
{
    Emitters before{.lights = std::vector<gpu::Light>(2), .emissions = {{1, 1, 1}, {0, 0, 0}}};
    before.lights[0].emission = {4, 2, 0};
    before.lights[1].emission = {1, 1, 0};
    Emitters now = before;
    EXPECT_EQ(lightRange(before, now), (LightRange{{1, 1, 1}, {1, 1, 1}}));
    EXPECT_TRUE(lightRange(before, now).isOneFactor());
    now.lights[0].emission = {2, 6, 0};
    EXPECT_EQ(lightRange(before, now), (LightRange{{0.5f, 1, 1}, {1, 3, 1}}));
    EXPECT_FALSE(lightRange(before, now).isOneFactor());
    now.emissions[0] = {1, 1, 0};
    EXPECT_EQ(lightRange(before, now), (LightRange{{0.5f, 1, 0}, {1, 3, 0}}));
    EXPECT_EQ(lightRange(before, now).surely().z, 0);
    now.lights[1].p0 = {1, 0, 0};
    EXPECT_EQ(lightRange(before, now), LightRange::anything());
    now = before;
    for (gpu::Light& light : now.lights)
        light.emission = {};
    now.emissions[0] = {};
    EXPECT_EQ(lightRange(before, now), LightRange{});
    now = before;
    now.emissions[1] = {0, 1, 0}; // a new light only adds
    EXPECT_EQ(lightRange(before, now).least.y, 1);
    EXPECT_GT(lightRange(before, now).most.y, 1e30f);
}

class Antialias : public GiTest
{
protected:
    std::vector<gpu::vec3> moved(const std::vector<gpu::vec3>& picture, gpu::vec2 from, bool continues)
    {
        const Buffer input = upload("test.picture", picture),
                     motions = upload("test.motions", std::vector<gpu::Motion>(kPixels, {.from = from, .distance = 1}));
        submitAlone([&](Recorder& rec) { stage_->recordMoving(rec, input, motions, kWidth, kHeight, 6, continues); });
        return contents<gpu::vec3>(stage_->shown(), kPixels);
    }
    float stood(float mean, uint32_t frames)
    {
        const float sum = mean * float(frames);
        const Buffer input = upload("test.sum", std::vector<gpu::vec3>(kPixels, {sum, sum, sum}));
        submitAlone([&](Recorder& rec) { stage_->recordStanding(rec, input, frames, kPixels); });
        return contents<gpu::vec3>(stage_->shown(), kPixels)[kPixels / 2].y;
    }
    void submitAlone(const std::function<void(Recorder&)>& record)
    {
        Recorder rec(device());
        rec.begin();
        record(rec);
        rec.submitAndWait();
    }
    void SetUp() override
    {
        GiTest::SetUp();
        stage_.emplace(device(), kPixels);
    }
    std::optional<AntialiasStage> stage_;
};

TEST_F(Antialias, LeavesNothingOfWhatTheSurroundingsNoLongerShow)
{
    moved(std::vector<gpu::vec3>(kPixels, {100, 50, 20}), {gpu::kNoMotion, 0}, false);
    for (const gpu::vec3 pixel : moved(std::vector<gpu::vec3>(kPixels), {0, 0}, true))
        EXPECT_LT(pixel.x + pixel.y + pixel.z, 1e-20); // but for what keeps a division from 0
}

/// A picture of noise that moves by whole pixels: each is the mean of the two frames where that lies within what its
/// surroundings show, and cubic convolution gives pixels back as they are.
TEST_F(Antialias, IsTheMeanOfTheFramesAtWholePixels)
{
    Random random(5);
    std::vector<gpu::vec3> first(kPixels), second(kPixels);
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const float grey =
            i % 2 == (i / kWidth) % 2 ? 1.0f : 0.0f; // a deviation of 1/2: old pixels of 0.4 to 0.6 lie within
        second[i] = {grey, grey, grey};
        const float old = random.between(0.4f, 0.6f);
        first[i] = {old, old, old};
    }
    moved(first, {gpu::kNoMotion, 0}, false);
    const auto got = moved(second, {-2, 1}, true);
    for (uint32_t y = 3; y < kHeight - 3; ++y)
        for (uint32_t x = 4; x < kWidth - 3; ++x)
            ASSERT_NEAR(got[y * kWidth + x].x, (first[(y + 1) * kWidth + x - 2].x + second[y * kWidth + x].x) / 2,
                        1e-5);
}

TEST_F(Antialias, StandingPictureGoesOnFromTheMovingOneAndForgetsIt)
{
    const std::vector<gpu::vec3> ones(kPixels, {1, 1, 1});
    moved(ones, {gpu::kNoMotion, 0}, false);
    for (int i = 0; i < 20; ++i)
        moved(ones, {0, 0}, true);
    float last = 1;
    for (uint32_t frames = 2; frames <= 70; ++frames)
    {
        const float now = stood(0, frames); // the frames' own mean is black
        EXPECT_LE(now, last);
        EXPECT_LE(last - now, 0.13f); // a ninth for the first frame beside eight, and a 64th
        last = now;
        if (frames >= 65)
        {
            EXPECT_EQ(now, 0);
        }
    }
    // Without a moving picture before it, nothing fades.
    moved(ones, {gpu::kNoMotion, 0}, false);
    EXPECT_EQ(stood(0, 2), 0);
}

TEST(FramePlan, GoesOnWhereTheLastFrameServes)
{
    Settings settings;
    const FrameTraits traits{.has_specular = true,
                             .has_caustics = true,
                             .reflects_roughly = true,
                             .has_noisy_direct = true,
                             .gathers_at_pixels = true,
                             .pixel_rays = 8};
    FrameInfo frame{};
    const FramePlan first = planFrame(settings, traits, frame);
    EXPECT_TRUE(first.remembers && first.antialiases && first.harmonics && first.gathers_at_samples);
    Settings preview = *presetSettings("preview");
    EXPECT_EQ(planFrame(preview, traits, frame).gather_rays, 8 * preview.gather_rays) << "there is no other light";
    frame.previous = frame.camera;
    EXPECT_EQ(planFrame(settings, traits, frame).denoise_passes + 1, first.denoise_passes);
    EXPECT_EQ(planFrame(preview, traits, frame).gather_rays, preview.gather_rays);
    frame.previous.reset();
    frame.accumulated = 40;
    const FramePlan standing = planFrame(settings, traits, frame);
    EXPECT_FALSE(standing.remembers || standing.antialiases || standing.harmonics || standing.gathers_at_samples);
    EXPECT_TRUE(standing.gathers_at_pixels);
    EXPECT_EQ(standing.denoise_passes, 0u);
    frame.accumulated = 0;
    settings.view = gpu::kViewCut;
    EXPECT_FALSE(planFrame(settings, traits, frame).remembers);
    settings.view = gpu::kViewNone;
    settings.term = gpu::kTermCaustics;
    const FramePlan caustics = planFrame(settings, traits, frame);
    EXPECT_TRUE(caustics.caustics && !caustics.makes_map && !caustics.direct);
    EXPECT_EQ(caustics.lightTerms(), gpu::kLightCaustics);
    EXPECT_GT(caustics.chain_depth, 0u);
    FrameTraits rough = traits; // no mirror anywhere: nothing that a caustic or a chain could begin with
    rough.has_caustics = false;
    EXPECT_FALSE(planFrame(settings, rough, frame).caustics);
    EXPECT_EQ(planFrame(settings, rough, frame).chain_depth, 0u);
}

/// Varnish over a diffuse wall: the pixel's own point keeps what the mirror does not take, the second has the mirrored part.
TEST_F(History, MirroredLightHasAPointOfItsOwn)
{
    builder_.quad({-90, -90, 0}, {180, 0, 0}, {0, 180, 0},
                  builder_.material({{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}}}));
    builder_.quad({-90, -90, 9}, {0, 180, 0}, {180, 0, 0}, builder_.material(lambert(0.3)));
    load();
    const PrimaryStage stage(device(), *scene_, kPixels, true);
    const RayStage rays(device(), *scene_);
    const Camera camera{
        .name = "", .position = {0, -2, 4}, .forward = {0, 0.6f, -0.8f}, .up = {0, 0.8f, 0.6f}, .vertical_fov = 0.5f};
    const Buffer emission = device().array<gpu::vec3>("test.emission", 2 * kPixels);
    std::optional<SurfaceBuffers> surface;
    submit(*scene_,
           [&](Recorder& rec)
           {
               surface.emplace(stage.record(
                   rec, rays,
                   {.camera = cameraParams(camera, kWidth, kHeight), .specular_depth = 4, .emission = emission}));
           });
    ASSERT_EQ(surface->point_count, 2 * kPixels);
    const auto all = contents<gpu::ShadingPoint>(surface->points, 2 * kPixels);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const gpu::ShadingPoint &own = all[pixel], &second = all[kPixels + pixel];
        ASSERT_NE(own.slot, gpu::kNone);
        ASSERT_NE(second.slot, gpu::kNone);
        EXPECT_EQ(own.depth, 0u);
        EXPECT_EQ(second.depth, 1u);
        EXPECT_NEAR(own.position.z, 0, 1e-5);
        EXPECT_NEAR(second.position.z, 9, 1e-4);
        const double cosine = -own.direction.z, fresnel = 0.04 + 0.96 * std::pow(1 - cosine, 5);
        EXPECT_NEAR(second.throughput.x, fresnel, 1e-5);
    }
}
} // namespace
