// Photon guiding: the learned distribution, and that guiding does not change the power in the map.
#include "runtime/stages/guide.h"
#include "tests/stages/gi_test.h"
#include "tests/stages/ray_test.h"

#include <algorithm>
#include <cmath>

namespace
{
constexpr uint32_t kPaths = 20000, kBounces = 2;

/// A closed room of 4 x 3 x 4 m with a hole of 1 x 1 m in its roof, beside a wide field, under a sun: of the sun's
/// photons few find the hole.
class Guides : public GiTest
{
protected:
    void SetUp() override
    {
        GiTest::SetUp();
        SceneBuilder builder;
        const uint32_t white = builder.material(lambert(0.5));
        builder.quad({-20, -0.1f, 20}, {40, 0, 0}, {0, 0, -40}, white);
        for (const auto& [corner, u, v] :
             {std::tuple<gpu::vec3, gpu::vec3, gpu::vec3>{{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}},
              {{-2, 0, -2}, {4, 0, 0}, {0, 3, 0}},
              {{-2, 0, 2}, {0, 3, 0}, {4, 0, 0}},
              {{-2, 0, -2}, {0, 3, 0}, {0, 0, 4}},
              {{2, 0, -2}, {0, 0, 4}, {0, 3, 0}},
              {{-2, 3, -2}, {4, 0, 0}, {0, 0, 1.5f}}, // the roof, around the hole
              {{-2, 3, 0.5f}, {4, 0, 0}, {0, 0, 1.5f}},
              {{-2, 3, -0.5f}, {1.5f, 0, 0}, {0, 0, 1}},
              {{0.5f, 3, -0.5f}, {1.5f, 0, 0}, {0, 0, 1}}})
            builder.quad(corner, u, v, white);
        builder.light({{"type", "directional"}, {"intensity", 2}},
                      {{"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}});
        scene_ = load(builder.compile());
        rays_.emplace(device(), *scene_);
        guide_.emplace(device(), *scene_, kPaths);
        photons_.emplace(device(), *scene_, PhotonKind::kGlobal, kPaths, kPaths * kBounces);
        submit(*scene_, [&](Recorder& rec) { guide_->reset(rec); });
    }

    /// Rays from within the room end all over its walls, which gives these importance.
    void look()
    {
        Random random(3);
        std::vector<gpu::Ray> rays;
        for (uint32_t i = 0; i < 40000; ++i)
        {
            const Double3 d = normalized({random.between(-1, 1), random.between(-1, -0.1f), random.between(-1, 1)});
            rays.push_back({.origin = {0.1f, 1, 0.2f},
                            .t_max = 1e30f,
                            .direction = {float(d.x), float(d.y), float(d.z)},
                            .path = i});
        }
        RayQueue queue(device(), "test.queue", uint32_t(rays.size()));
        queue.size = sizeBuffer(uint32_t(rays.size()));
        queue.rays = device().uploadTexels<gpu::Ray>("test.rays", rays);
        const Buffer hits = device().texelArray<gpu::Hit>("test.hits", rays.size());
        submit(*scene_,
               [&](Recorder& rec)
               {
                   rays_->closest(rec, queue, hits, 1);
                   guide_->splat(rec, queue, uint32_t(rays.size()), hits);
               });
    }

    /// One emission of photons, which trains the guide.
    PhotonStage::Output trace(uint32_t round)
    {
        std::optional<PhotonStage::Output> out;
        submit(*scene_,
               [&](Recorder& rec)
               {
                   out.emplace(photons_->record(rec, *rays_,
                                                {.path_count = kPaths,
                                                 .first_path = round * kPaths,
                                                 .seed = 7,
                                                 .guide = &*guide_,
                                                 .bounce_limit = kBounces}));
                   guide_->learn(rec, *out);
               });
        return *out;
    }
    std::vector<gpu::Photon> emit(uint32_t round) { return stored(trace(round)); }

    /// The learned probability of each cell.
    std::vector<double> probabilities() const
    {
        const auto distribution = contents<gpu::GuideDistribution>(guide_->distribution(), 1)[0];
        EXPECT_EQ(distribution.groups[gpu::kGuideGroups - 1], 1);
        std::vector<double> result;
        for (uint32_t i = 0; i < gpu::kGuideTotal; ++i)
        {
            const uint32_t group = i / gpu::kGuideCells;
            const double of_group =
                double(distribution.groups[group]) - (group > 0 ? distribution.groups[group - 1] : 0);
            result.push_back(of_group * (double(distribution.cells[i]) -
                                         (i % gpu::kGuideCells > 0 ? distribution.cells[i - 1] : 0)));
        }
        return result;
    }

    static bool isFloorOfRoom(const gpu::Photon& p)
    {
        return std::abs(p.position.y) < 1e-3 && std::abs(p.position.x) < 2 && std::abs(p.position.z) < 2;
    }

    std::unique_ptr<SceneGpu> scene_;
    std::optional<RayStage> rays_;
    std::optional<GuideStage> guide_;
    std::optional<PhotonStage> photons_;
};

TEST_F(Guides, SendPhotonsWhereLightIsWanted)
{
    look();
    const auto before = emit(0);
    const auto after = emit(1);
    const auto useful = [](const std::vector<gpu::Photon>& photons)
    { return std::ranges::count_if(photons, isFloorOfRoom); };
    fmt::print("  photons on the floor of the room: {} of {}, {} of {} when guided\n", useful(before), before.size(),
               useful(after), after.size());
    // The hole is 1/2500 of the sun's disc: nearly all photons were wasted. More of them by 5 standard deviations of two
    // independent counts is no chance.
    EXPECT_GT(double(useful(after) - useful(before)), 5 * std::sqrt(double(useful(after) + useful(before))));
}

TEST_F(Guides, ChangeNoPower)
{
    look();
    // The sun's direct power, exact without bounces: its patch on the floor has 1 m^2.
    const auto direct = [](const gpu::Photon& p)
    { return isFloorOfRoom(p) && std::abs(p.position.x) < 0.5f && std::abs(p.position.z) < 0.5f; };
    constexpr uint32_t
        kRounds = 8,
        kBefore = 4; // until every cell of the hole is learned: photons through other cells are few and of high power
    for (uint32_t round = 0; round < kBefore; ++round)
        (void)emit(round);
    double patch = 0, patch2 = 0, field = 0, field2 = 0;
    for (uint32_t round = kBefore; round < kBefore + kRounds; ++round)
    {
        for (const gpu::Photon& p : emit(round))
        {
            const double power = p.power.x;
            if (direct(p) && unpackedNormal(p.direction).y < -0.9999) // the sun's own
                patch += power, patch2 += power * power;
            if (p.position.y < -0.05f && unpackedNormal(p.direction).y < -0.9999)
                field += power, field2 += power * power;
        }
    }
    const double want_patch = 2, want_field = 2 * (40.0 * 40 - 4 * 4);
    fmt::print("  sun through the hole: {:.4f} W of {:.4f} W, standard error {:.4f}; on the field {:.1f} W of {:.1f} "
               "W, {:.1f}\n",
               patch / kRounds, want_patch, std::sqrt(patch2) / kRounds, field / kRounds, want_field,
               std::sqrt(field2) / kRounds);
    EXPECT_LE(std::sqrt(patch2) / kRounds, 0.05 * want_patch) << "too few photons to tell";
    EXPECT_NEAR(patch / kRounds, want_patch, 4 * std::sqrt(patch2) / kRounds);
    EXPECT_NEAR(field / kRounds, want_field, 4 * std::sqrt(field2) / kRounds);
}

TEST_F(Guides, AreNoHelpWithOneLamp)
{
    EXPECT_TRUE(GuideStage::helps(*scene_));
    SceneBuilder builder;
    builder.box({-1, 0, -1}, {1, 1, 1}, builder.material(lambert(0.5)), true);
    builder.light({{"type", "point"}, {"intensity", 1}}, {{"translation", {0, 0.5, 0}}});
    EXPECT_FALSE(GuideStage::helps(*load(builder.compile())));
}

/// The roots of the estimates, of a group of 32 x 32 cells half of each spread by 1 2 1 both ways.
std::vector<double> spread(const std::vector<double>& squares)
{
    std::vector<double> result;
    const auto root = [&](uint32_t group, int x, int y)
    {
        const int side = gpu::kGuideSide;
        const bool outside = x < 0 || y < 0 || x >= side || y >= side;
        return outside ? 0 : std::sqrt(squares[group * gpu::kGuideCells + size_t(y * side + x)]);
    };
    for (uint32_t i = 0; i < squares.size(); ++i)
    {
        const uint32_t group = i / gpu::kGuideCells;
        const int x = i % gpu::kGuideSide, y = i % gpu::kGuideCells / gpu::kGuideSide;
        double around = 0;
        for (int k = 0; k < 9; ++k)
            around += root(group, x + k % 3 - 1, y + k / 3 - 1) * (k % 3 == 1 ? 2 : 1) * (k / 3 == 1 ? 2 : 1) / 16.0;
        const double own = std::sqrt(squares[i]);
        result.push_back(group < gpu::kGuideInfiniteLights ? own + gpu::kGuideSpread * (around - own) : own);
    }
    return result;
}

/// splat, value, estimate and learn against sums over the photons, by cell.
TEST_F(Guides, LearnTheRootMeanSquareOfWhatEachCellsPathsGive)
{
    look();
    const std::vector<double> start = probabilities();
    const auto importance = contents<uint32_t>(guide_->importance(), gpu::kGuideBins);
    const PhotonStage::Output out = trace(0);
    const auto photons = contents<gpu::Photon>(out.photons, out.capacity);
    const auto slots = contents<uint32_t>(out.slots, countOf(out.size));
    const auto offsets = contents<uint32_t>(out.offsets, kPaths), counts = contents<uint32_t>(out.counts, kPaths);
    const auto place = [&](const gpu::Photon& photon) // on walls along the axes
    {
        const Double3 at = gridPlace(scene_->info(), photon.position);
        const auto along = [](double x) { return uint32_t(std::min(x * gpu::kGuideVoxels, gpu::kGuideVoxels - 1.0)); };
        const uint32_t voxel = (along(at.z) * gpu::kGuideVoxels + along(at.y)) * gpu::kGuideVoxels + along(at.x);
        const Double3 n = unpackedNormal(photon.normal);
        const uint32_t side = n.x < -0.9 ? 0 : n.x > 0.9 ? 1 : n.y < -0.9 ? 2 : n.y > 0.9 ? 3 : n.z < -0.9 ? 4 : 5;
        return voxel * gpu::kGuideSides + side;
    };
    const auto cells = contents<uint32_t>(guide_->cells(), kPaths);
    const auto scale = contents<gpu::ViewScale>(scene_->viewScale(), 1)[0];
    const auto area = [&](const gpu::Photon& photon) // of a bin on a wall along the axes
    {
        const Double3 at = Double3(photon.position) - Double3(scale.focus), n = unpackedNormal(photon.normal);
        const auto side = [&](double x) { return std::hypot(x, double(scale.distance)); };
        return std::abs(n.x) > 0.9   ? side(at.y) * side(at.z)
               : std::abs(n.y) > 0.9 ? side(at.x) * side(at.z)
                                     : side(at.x) * side(at.y);
    };
    std::vector<double> squares(start.size());
    uint32_t useful = 0;
    for (uint32_t path = 0; path < kPaths; ++path)
    {
        double value = 0;
        for (uint32_t n = 0; n < counts[path]; ++n)
        {
            const gpu::Photon& photon = photons[slots[offsets[path] + n]];
            const double rays = std::min(importance[place(photon)], gpu::kGuideMostImportance);
            const gpu::vec3 p = photon.power;
            value += rays * (0.2126 * p.x + 0.7152 * p.y + 0.0722 * p.z) / area(photon);
            useful += rays > 0;
        }
        if (cells[path] != gpu::kNone)
            squares[cells[path]] += value * value * start[cells[path]];
    }
    ASSERT_GE(useful, 5) << "too few for a test";
    const std::vector<double> wanted = spread(squares), learned = probabilities();
    double total = 0;
    for (const double w : wanted)
        total += w;
    // Rounding of the power and of the distribution's running sums, of a part in a group of 1.
    for (size_t i = 0; i < learned.size(); ++i)
        EXPECT_NEAR(learned[i], gpu::kGuideUnguided * start[i] + (1 - gpu::kGuideUnguided) * wanted[i] / total, 1e-6)
            << "cell " << i;
}

/// As well spread as the sequence that chooses the cells: any interval of its first coordinate gets its part of 2^k points
/// up to one at either end. (Independent numbers are for the test of pickCell by Pearson's statistic.)
TEST_F(Guides, LeaveByTheLearnedDistribution)
{
    look();
    (void)trace(0);
    const std::vector<double> learned = probabilities();
    constexpr uint32_t kPowerOfTwo = 16384;
    static_assert(kPowerOfTwo <= kPaths);
    const Buffer starts = device().array<gpu::PhotonStart>("test.starts", kPowerOfTwo);
    submit(*scene_, [&](Recorder& rec)
           { guide_->emit(rec, starts, {.path_count = kPowerOfTwo, .first_path = 0, .seed = 9, .aim = 0}); });
    std::vector<double> counts(learned.size());
    for (const uint32_t cell : contents<uint32_t>(guide_->cells(), kPowerOfTwo))
        ++counts.at(cell);
    for (size_t i = 0; i < learned.size(); ++i)
        EXPECT_NEAR(counts[i], learned[i] * kPowerOfTwo, 2) << "cell " << i;
    EXPECT_GE(std::ranges::max(learned) * kPowerOfTwo, 20) << "too even for a test";
}
} // namespace
