// Debug views against the output of the stage that each shows.
#include "runtime/stages/views.h"
#include "tests/stages/ray_test.h"
#include "tests/stages/shading_points.h"

#include <cstring>
#include <limits>
#include <map>
#include <set>

namespace
{
constexpr uint32_t kWidth = 48, kHeight = 40, kPixels = kWidth * kHeight;
constexpr float kFloor = 3; // metres: half its side, the scene's longest
// Of a colour's components: pow() is exp2(y log2(x)), which Vulkan lets be wrong by some 2^-20.
constexpr double kColorError = 1e-5;

using Color = std::array<float, 3>;
using Colors = std::vector<Color>; // [kPixels]

/// What a white picture becomes behind a view.
Double3 ground()
{
    return {0.08, 0.16, 0.4};
}

double fromSrgb(double x)
{
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
}

Double3 heatColor(double t)
{
    const Double3 colors[]{{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
    const double at = 4 * std::clamp(t, 0.0, 1.0);
    const int i = std::min(int(at), 3);
    const Double3 srgb = 1.0 / 255 * ((i + 1 - at) * colors[i] + (at - i) * colors[i + 1]);
    return {fromSrgb(srgb.x), fromSrgb(srgb.y), fromSrgb(srgb.z)};
}

double difference(Color a, Double3 b)
{
    return std::max({std::abs(a[0] - b.x), std::abs(a[1] - b.y), std::abs(a[2] - b.z)});
}

uint32_t zOrder(uint32_t x, uint32_t y)
{
    uint32_t index = 0;
    for (int bit = 15; bit >= 0; --bit)
        index = index << 2 | (y >> bit & 1) << 1 | (x >> bit & 1);
    return index;
}

class Views : public GiTest
{
protected:
    /// Walls, a sphere and a mirror before a dark background.
    void SetUp() override
    {
        GiTest::SetUp();
        builder_.floor(kFloor, 0, builder_.material(lambert(0.7)));
        builder_.quad({-1.5f, 0, -1.5f}, {2, 0, 0}, {0, 2, 0}, builder_.material(lambert(0.5)));
        builder_.sphere({-0.4f, 0.4f, 0}, 0.4f, 16, true, builder_.material(lambert(0.6)));
        builder_.quad({-1.5f, 0, 0.9f}, {0, 0, -1.5f}, {0, 1, 0}, builder_.material(mirror(1, 1, 1)));
        builder_.light({{"type", "point"}, {"intensity", 3}}, {{"translation", {1, 1.5, 1}}});
        const auto path = builder_.compile();
        scene_ = load(path);
        points_.emplace(device(), *scene_, path, kCamera, kWidth, kHeight);
        shading_ = contents<gpu::ShadingPoint>(points_->gpu->points, kPixels);
        stage_.emplace(device(), *scene_, kPixels);
    }

    using Record = std::function<void(Recorder&, const ViewsStage::Input&)>;
    /// What a view makes of a white picture.
    Colors viewed(uint32_t view, const Record& record,
                  std::vector<gpu::vec3> picture = std::vector<gpu::vec3>(kPixels, {1, 1, 1}), uint32_t budget = 1)
    {
        const Buffer radiance = upload("test.radiance", std::move(picture));
        const ViewsStage::Input in{.view = view,
                                   .camera = cameraParams(kCamera, kWidth, kHeight),
                                   .points = points_->gpu->points,
                                   .radiance = radiance,
                                   .budget = budget};
        submit(*scene_, [&](Recorder& rec) { record(rec, in); });
        Colors colors;
        for (const gpu::vec3& c : contents<gpu::vec3>(radiance, kPixels))
        {
            colors.push_back({c.x, c.y, c.z});
            EXPECT_TRUE(std::min({c.x, c.y, c.z}) >= 0 && std::max({c.x, c.y, c.z}) <= 1);
        }
        return colors;
    }

    void place(SamplesMode mode, uint32_t budget)
    {
        samples_stage_.emplace(device(), kWidth, kHeight, budget);
        const RayStage rays(device(), *scene_);
        submit(*scene_,
               [&](Recorder& rec)
               {
                   (void)samples_stage_->record(rec, rays,
                                                {.diffuse_points = points_->gpu->diffuse_points,
                                                 .mode = mode,
                                                 .budget = budget,
                                                 .iterations = 3,
                                                 .alpha = float(0.3 * diagonalOf(*scene_)),
                                                 .seed = 1});
               });
        samples_ = samples_stage_->download(device());
        ASSERT_GT(samples_.size(), budget / 2);
    }

    bool onFloor(uint32_t pixel) const
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        return p.exists && std::abs(p.position.y) < 1e-6 && p.normal.y > 0.99;
    }

    static inline const Camera kCamera{
        .name = "",
        .position = {0.4f, 1.2f, 2.4f},
        .forward = normalize({-0.15f, -0.35f, -1}),
        .up = normalize(cross(cross(gpu::vec3{-0.15f, -0.35f, -1}, gpu::vec3{0, 1, 0}), gpu::vec3{-0.15f, -0.35f, -1})),
        .vertical_fov = 0.9f,
        .orthographic_height = 0};
    SceneBuilder builder_;
    std::unique_ptr<SceneGpu> scene_;
    std::optional<ShadingPoints> points_;
    std::vector<gpu::ShadingPoint> shading_;
    std::optional<ViewsStage> stage_;
    std::optional<SamplesStage> samples_stage_;
    std::vector<gpu::Sample> samples_;
};

TEST_F(Views, ShowNormalsAndPositionsOfTheShadingPoints)
{
    const auto record = [&](Recorder& rec, const ViewsStage::Input& in) { stage_->recordPoints(rec, in); };
    const Colors normals = viewed(gpu::kViewNormals, record), positions = viewed(gpu::kViewPositions, record);
    const Double3 low = scene_->info().bounds_min, extent = Double3(scene_->info().bounds_max) - low;
    uint32_t background = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        background += !p.exists;
        const Double3 n = p.exists ? 0.5 * p.normal + Double3(0.5, 0.5, 0.5) : Double3();
        const Double3 x = p.exists ? p.position - low : Double3();
        EXPECT_LT(difference(normals[pixel], {fromSrgb(n.x), fromSrgb(n.y), fromSrgb(n.z)}), kColorError);
        EXPECT_LT(difference(positions[pixel],
                             {fromSrgb(x.x / extent.x), fromSrgb(x.y / extent.y), fromSrgb(x.z / extent.z)}),
                  kColorError);
    }
    EXPECT_GT(background, 0u);
    EXPECT_LT(background, kPixels / 2);
}

TEST_F(Views, ShowADotAtEverySample)
{
    place(SamplesMode::kKmeans, 40);
    const Colors colors = viewed(gpu::kViewSamples, [&](Recorder& rec, const ViewsStage::Input& in)
                                 { stage_->recordSamples(rec, in, samples_stage_->output()); });
    std::set<uint32_t> expected, dots;
    for (const gpu::Sample& sample : samples_)
        expected.insert(sample.pixel);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        if (difference(colors[pixel], ground()) > kColorError)
            dots.insert(pixel);
    EXPECT_EQ(dots, expected);
}

TEST_F(Views, ShowAsManyColorsAsThereAreClusters)
{
    place(SamplesMode::kKmeans, 40);
    const Colors colors =
        viewed(gpu::kViewClusters, [&](Recorder& rec, const ViewsStage::Input& in)
               { stage_->recordQuadtree(rec, in, samples_stage_->output(), samples_stage_->quadtree()); });
    const SamplesStage::Quadtree quadtree = samples_stage_->quadtree();
    ASSERT_EQ(quadtree.stride, 1u);
    const auto owners = contents<gpu::uvec2>(quadtree.owners, quadtree.owners.size() / sizeof(gpu::uvec2));
    std::set<uint32_t> sample_pixels, clusters;
    for (const gpu::Sample& sample : samples_)
        sample_pixels.insert(sample.pixel);
    std::map<uint32_t, Color> color_of;
    std::set<Color> distinct;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        const bool takes_part = p.exists && p.diffuse.x > 0;
        const uint32_t owner = owners[zOrder(pixel % kWidth, pixel / kWidth)].x;
        EXPECT_EQ(owner != gpu::kNone, takes_part);
        if (owner != gpu::kNone)
            clusters.insert(owner);
        if (sample_pixels.contains(pixel))
        {
            EXPECT_EQ(colors[pixel], (Color{0, 0, 0}));
        }
        else if (!takes_part)
        {
            EXPECT_LT(difference(colors[pixel], ground()), kColorError);
        }
        else
        {
            EXPECT_EQ(color_of.emplace(owner, colors[pixel]).first->second, colors[pixel]);
            distinct.insert(colors[pixel]);
        }
    }
    EXPECT_EQ(clusters.size(), samples_.size());
    EXPECT_EQ(distinct.size(), color_of.size()); // less clusters of one pixel, which is their sample's
    EXPECT_GT(distinct.size(), 30u);
}

TEST_F(Views, ShowTheBudgetsWhichSumToTheSamples)
{
    constexpr uint32_t kBudget = 64, kLevel = 4; // 4^4 points of 48 x 40 at 64 samples: 8.5 a node; a level below, 2.1
    place(SamplesMode::kSeeded, kBudget);
    const Colors colors = viewed(
        gpu::kViewBudget,
        [&](Recorder& rec, const ViewsStage::Input& in)
        { stage_->recordQuadtree(rec, in, samples_stage_->output(), samples_stage_->quadtree()); },
        std::vector<gpu::vec3>(kPixels), kBudget);
    const double mean = double(kBudget) * (1 << (2 * kLevel)) / kPixels;
    std::map<uint32_t, uint32_t> samples_of; // by node; seeds that k-means does not move lie in their node
    for (const gpu::Sample& sample : samples_)
        ++samples_of[zOrder(sample.pixel % kWidth, sample.pixel / kWidth) >> (2 * kLevel)];
    std::map<uint32_t, uint32_t> shown;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const uint32_t node = zOrder(pixel % kWidth, pixel / kWidth) >> (2 * kLevel);
        uint32_t best = 0;
        for (uint32_t budget = 1; budget <= kBudget; ++budget)
            if (difference(colors[pixel], heatColor(std::log2(1 + budget / mean) / 4)) <
                difference(colors[pixel], heatColor(std::log2(1 + best / mean) / 4)))
                best = budget;
        EXPECT_LT(difference(colors[pixel], heatColor(std::log2(1 + best / mean) / 4)), kColorError);
        EXPECT_EQ(best, samples_of[node]) << node;
        shown[node] = best;
    }
    uint32_t sum = 0;
    for (const auto& [node, budget] : shown)
        sum += budget;
    EXPECT_EQ(sum, kBudget);
    EXPECT_EQ(samples_.size(), kBudget);
}

TEST_F(Views, ShowPhotonsThatTheEyeSeesAndNoOthers)
{
    std::vector<gpu::Photon> photons;
    const auto add = [&](gpu::vec3 position)
    {
        photons.push_back({.position = position,
                           .direction = packedNormal({0, -1, 0}),
                           .power = {0.02f, 0.01f, 0},
                           .normal = packedNormal({0, 1, 0})});
    };
    std::set<uint32_t> expected, dots;
    for (uint32_t pixel = 0; pixel < kPixels; pixel += 17)
    {
        const gpu::ShadingPoint& point = shading_[pixel];
        if (point.slot == gpu::kNone || point.depth != 0)
            continue;
        const bool hidden = pixel % 2 == 0; // behind what is seen there
        add(hidden ? point.position + 3.0f * point.direction : point.position);
        if (!hidden)
            expected.insert(pixel);
    }
    ASSERT_GT(expected.size(), 30u);
    add({0.4f, 1.2f, 4}); // behind the eye
    ASSERT_LT(photons.size(), kPixels / gpu::kViewPhotonShare);
    const auto map = mapOf(*scene_, photons);
    const Colors colors = viewed(gpu::kViewPhotons, [&](Recorder& rec, const ViewsStage::Input& in)
                                 { stage_->recordPhotons(rec, in, *map->gpu); });
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        if (difference(colors[pixel], ground()) > kColorError)
        {
            dots.insert(pixel);
            EXPECT_LT(difference(colors[pixel], {1, 0.5, 0}), kColorError);
        }
    EXPECT_EQ(dots, expected);
}

TEST_F(Views, ShowTheNodesOfOneLevelOfThePhotonTree)
{
    // A lattice of 64 x 64 pairs of photons over the floor: the level of 4096 nodes has one for each square of the
    // lattice.
    constexpr int kSide = 64;
    static_assert(kSide * kSide == gpu::kViewTreeNodes);
    std::vector<gpu::Photon> photons;
    const auto center = [](int i) { return kFloor * (2 * (float(i) + 0.5f) / kSide - 1); };
    for (int i = 0; i < 2 * kSide * kSide; ++i)
        photons.push_back({.position = {center(i / 2 % kSide), 0, center(i / 2 / kSide)},
                           .direction = packedNormal({0, -1, 0}),
                           .power = {1, 1, 1},
                           .normal = packedNormal({0, 1, 0})});
    const auto map = mapOf(*scene_, photons);
    const Colors colors = viewed(gpu::kViewTree, [&](Recorder& rec, const ViewsStage::Input& in)
                                 { stage_->recordTree(rec, in, *map->gpu); });
    std::map<std::pair<int, int>, Color> color_of;
    std::map<Color, std::pair<int, int>> square_of;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        if (!onFloor(pixel))
            continue;
        const double x = (points_->points[pixel].position.x / kFloor + 1) / 2 * kSide,
                     z = (points_->points[pixel].position.z / kFloor + 1) / 2 * kSide;
        if (std::abs(x - std::round(x)) < 1e-3 || std::abs(z - std::round(z)) < 1e-3)
            continue; // on the edge of two
        const std::pair<int, int> square{int(x), int(z)};
        EXPECT_EQ(color_of.emplace(square, colors[pixel]).first->second, colors[pixel]);
        EXPECT_EQ(square_of.emplace(colors[pixel], square).first->second, square);
    }
    EXPECT_GT(color_of.size(), 100u);
}

TEST_F(Views, ShowTheNearestNodeOfTheCut)
{
    Random random(3);
    std::vector<gpu::CutNode> nodes;
    while (nodes.size() < 60)
    {
        const ShadingPoints::Point& p = points_->points[random.below(kPixels)];
        if (p.exists)
            nodes.push_back({.center = {float(p.position.x), float(p.position.y), float(p.position.z)},
                             .support = random.between(0.05f, 0.5f),
                             .irradiance = {1, 1, 1},
                             .normal_and_eye = packedCutNormal(p.normal)});
    }
    const auto cut = cutOf(*scene_, nodes);
    const Colors colors = viewed(gpu::kViewCut, [&](Recorder& rec, const ViewsStage::Input& in)
                                 { stage_->recordCut(rec, in, *cut->gpu); });
    std::map<uint32_t, Color> color_of;
    std::map<Color, uint32_t> node_of;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        if (!onFloor(pixel)) // elsewhere the geometric normal differs from the expected one
            continue;
        double best = 1e30, second = 1e30;
        uint32_t nearest = 0;
        for (uint32_t i = 0; i < cut->sorted.size(); ++i)
        {
            const Double3 n = unpackedCutNormal(cut->sorted[i]),
                          d = Double3(cut->sorted[i].center) - points_->points[pixel].position;
            const double distance2 = dot(n, {0, 1, 0}) > 0.2 ? dot(d, d) + 15 * std::pow(dot(d, n), 2) : 1e30;
            if (distance2 < best)
                second = best, best = distance2, nearest = i;
            else
                second = std::min(second, distance2);
        }
        if (second < 1.001 * best)
            continue; // which of the two is a matter of rounding
        EXPECT_EQ(color_of.emplace(nearest, colors[pixel]).first->second, colors[pixel]);
        EXPECT_EQ(node_of.emplace(colors[pixel], nearest).first->second, nearest);
    }
    EXPECT_GT(color_of.size(), 10u);
}

TEST_F(Views, MarkPixelsThatAreNotFinite)
{
    std::vector<gpu::vec3> picture(kPixels, {1, 1, 1});
    const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const std::map<uint32_t, gpu::vec3> bad{
        {0, {nan, 0, 0}}, {77, {1, inf, 0}}, {500, {0, 0, -inf}}, {kPixels - 1, {nan, nan, nan}}};
    for (const auto& [pixel, value] : bad)
        picture[pixel] = value;
    const Colors colors = viewed(
        gpu::kViewNonFinite, [&](Recorder& rec, const ViewsStage::Input& in) { stage_->recordNonFinite(rec, in); },
        picture);
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
        EXPECT_LT(difference(colors[pixel], bad.contains(pixel) ? Double3(1, 0, 1) : ground()), kColorError);
}

TEST_F(Views, ShowHowFarThePictureIsFromAReference)
{
    constexpr uint32_t kWide = 2 * kWidth, kHigh = 2 * kHeight, kSamples = 4;
    const float inf = std::numeric_limits<float>::infinity();
    std::vector<gpu::vec3> reference(kWide * kHigh), sum(kPixels);
    double mean = 0;
    for (uint32_t i = 0; i < reference.size(); ++i)
    {
        reference[i] = {1, 0.5f + float(i % 7), i % 5 == 0 ? 0 : 0.25f * float(i % 11)};
        if (i % 13 == 0)
            reference[i] = {0, 0, 0};
        mean += double(std::max({reference[i].x, reference[i].y, reference[i].z})) / double(reference.size());
    }
    const auto nearest = [](uint32_t pixel) { return (2 * (pixel / kWidth) + 1) * kWide + 2 * (pixel % kWidth) + 1; };
    const std::array<double, 6> errors{0, 1e-4, 0.003, 0.1, 0.9, 20};
    std::vector<double> want(kPixels);
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const gpu::vec3 r = reference[nearest(i)];
        const double off = errors[i % errors.size()] * (i % 2 == 0 ? 1 : -1) * (r.y > 0 ? double(r.y) : 1);
        sum[i] = float(kSamples) * gpu::vec3{r.x, float(double(r.y) + off), r.z};
        // As rounded: the difference of two near numbers keeps few digits.
        const double got = std::abs(double(sum[i].y) / kSamples - double(r.y));
        want[i] = got / std::max({double(r.x), double(r.y), double(r.z), 0.01 * mean});
    }
    sum[5].z = inf;
    ErrorView view(device(), reference, kWide, kHigh, kPixels);
    Recorder rec(device());
    rec.begin(scene_->descriptorSet());
    const Buffer buffer = upload("test.sum", std::move(sum));
    view.record(rec, buffer, kSamples, kWidth, kHeight);
    rec.submitAndWait();
    const auto colors = device().download<Color>(view.colors(), kPixels);
    for (uint32_t i = 0; i < kPixels; ++i)
    {
        const double t = 1 + std::log10(std::max(want[i], 1e-3)) / 3;
        EXPECT_LT(difference(colors[i], i == 5 ? Double3(1, 0, 1) : heatColor(t)), 1e-4) << i << ' ' << want[i];
    }
}

TEST_F(Views, ShowTheErrorInPlaceOfThePictureWhichGoesOn)
{
    Settings settings = smallSettings();
    Renderer renderer(device(), *scene_, Mode::kGi, kWidth, kHeight, settings);
    const auto shown = [&](uint32_t view)
    {
        settings.view = view;
        Recorder rec(device());
        rec.begin(scene_->descriptorSet());
        renderer.record(rec, kCamera, settings, 0);
        rec.submitAndWait();
        return renderer.picture(device());
    };
    const auto picture = shown(gpu::kViewNone);
    const auto nothing_to_compare = shown(gpu::kViewError);
    renderer.restart();
    const auto again = shown(gpu::kViewNone);
    EXPECT_EQ(std::memcmp(picture.data(), again.data(), kPixels * sizeof(gpu::vec3)), 0);
    renderer.compareWith(device(), nothing_to_compare, kWidth, kHeight);
    const auto none = shown(gpu::kViewError); // the second sample again
    EXPECT_EQ(renderer.sampleCount(), 2u);
    for (const gpu::vec3& color : none)
        EXPECT_LT(difference({color.x, color.y, color.z}, heatColor(0)), kColorError);
    const auto some = shown(gpu::kViewError);
    EXPECT_NE(std::memcmp(none.data(), some.data(), kPixels * sizeof(gpu::vec3)), 0);
}

TEST_F(Views, LeaveThePictureBehindThemAloneWhereThereIsNothingToShow)
{
    place(SamplesMode::kKmeans, 40);
    const auto no_photons = mapOf(*scene_, {});
    const auto no_nodes = cutOf(*scene_, {});
    for (const Record& record :
         {Record([&](Recorder&rec, const ViewsStage::Input&in) { stage_->recordPhotons(rec, in, *no_photons->gpu); }),
          Record([&](Recorder&rec, const ViewsStage::Input&in) { stage_->recordTree(rec, in, *no_photons->gpu); }),
          Record([&](Recorder&rec, const ViewsStage::Input&in) { stage_->recordCut(rec, in, *no_nodes->gpu); })})
        for (const Color& color : viewed(gpu::kViewPhotons, record))
            EXPECT_LT(difference(color, ground()), kColorError);
}

TEST_F(Views, StandStillInAStandingPicture)
{
    Settings settings = smallSettings();
    for (settings.view = gpu::kViewNormals; settings.view <= gpu::kViewNonFinite; ++settings.view)
    {
        SCOPED_TRACE(settings.view);
        const Picture one = renderGi(*scene_, kCamera, settings, 1, kWidth, kHeight),
                      two = renderGi(*scene_, kCamera, settings, 2, kWidth, kHeight);
        EXPECT_EQ(std::memcmp(one.pixels.data(), two.pixels.data(), kPixels * sizeof(gpu::vec3)) == 0,
                  showsOneFrame(settings.view));
    }
}

TEST_F(Views, ShowTheIrradianceThatIndirectLightIsMadeOf)
{
    Settings settings = smallSettings();
    settings.term = gpu::kTermIndirect;
    const Picture indirect = renderGi(*scene_, kCamera, settings, 1, kWidth, kHeight);
    settings.view = gpu::kViewIrradiance;
    const Picture irradiance = renderGi(*scene_, kCamera, settings, 1, kWidth, kHeight);
    double brightest = 0;
    for (uint32_t pixel = 0; pixel < kPixels; ++pixel)
    {
        const ShadingPoints::Point& p = points_->points[pixel];
        const double reflectance = p.exists ? p.diffuse.x * p.throughput.x : 0;
        EXPECT_TRUE(reflectance != 0 || irradiance.pixels[pixel].x == 0);
        EXPECT_NEAR(indirect.pixels[pixel].x, reflectance * irradiance.pixels[pixel].x,
                    1e-5 * indirect.pixels[pixel].x);
        brightest = std::max(brightest, double(irradiance.pixels[pixel].x));
    }
    EXPECT_GT(brightest, 0);
}
} // namespace
