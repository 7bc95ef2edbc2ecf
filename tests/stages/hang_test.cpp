// Objects that hang anew in the tree above them: hits are those of the package's tree, and of a package compiled at that time.
#include "runtime/object_bounds.h"
#include "runtime/stages/pose.h"
#include "tests/compiler/posed_package.h"
#include "tests/stages/brute_force.h"
#include "tests/stages/moving_scene.h"
#include "tests/stages/ray_test.h"
#include "tools/scenes/scenes.h"

#include <limits>

namespace
{
constexpr double kNever = std::numeric_limits<double>::infinity();

package::Package open(const std::filesystem::path& path)
{
    auto package = package::Package::open(path);
    check(bool(package), "{}", package ? "" : package.error().message);
    return std::move(*package);
}

/// A scene that is shown at poses, one after the other.
struct Shown
{
    Shown(const Device& device, const std::filesystem::path& path, double drift)
        : scene{open(path), nullptr}, rec_(device)
    {
        auto made = SceneGpu::create(device, scene.package);
        check(bool(made), "{}", made ? "" : made.error().message);
        scene.gpu = std::move(*made);
        stage_.emplace(device, *scene.gpu, scene.package, drift);
    }

    void at(double seconds)
    {
        rec_.begin(scene.gpu->descriptorSet());
        stage_->record(rec_, package::poseAt(scene.package, 0, seconds));
        rec_.submitAndWait();
    }

    LoadedScene scene;

private:
    std::optional<PoseStage> stage_;
    Recorder rec_;
};

class Hanging : public Rays
{
protected:
    /// References to children, four a node.
    static std::vector<uint32_t> children(const Shown& shown)
    {
        std::vector<uint32_t> all;
        for (const gpu::BvhNode& node : device().download<gpu::BvhNode>(shown.scene.gpu->buffer(gpu::kBvhNodesBinding),
                                                                        shown.scene.package.bvhNodes().size()))
            all.insert(all.end(), {node.child.x, node.child.y, node.child.z, node.child.w});
        return all;
    }
    static std::vector<gpu::BvhTriangle> slots(const Shown& shown)
    {
        return device().download<gpu::BvhTriangle>(shown.scene.gpu->buffer(gpu::kBvhTrianglesBinding),
                                                   shown.scene.package.bvhTriangles().size());
    }
    /// Half of them towards triangles that move.
    static std::vector<gpu::Ray> raysInto(std::span<const gpu::BvhTriangle> triangles, uint32_t first_moving,
                                          gpu::vec3 low, gpu::vec3 high, uint32_t count, uint32_t seed)
    {
        Random random(seed);
        std::vector<gpu::Ray> rays;
        for (uint32_t i = 0; i < count; ++i)
        {
            const gpu::vec3 from = random.inBox(low, high);
            const gpu::BvhTriangle& aim =
                triangles[first_moving + random.below(uint32_t(triangles.size()) - first_moving)];
            const gpu::vec3 to = i % 2 == 0 ? random.onTriangle(aim) : random.inBox(low, high);
            rays.push_back({from, kFar, directionTo(to, from), i});
        }
        return rays;
    }
    /// To the bit, nearest hits and shadows.
    static void expectSameHits(const Shown& a, const Shown& b, std::span<const gpu::Ray> rays)
    {
        const std::vector<gpu::Hit> of_a = closest(a.scene, rays), of_b = closest(b.scene, rays);
        const auto lit_a = visible(a.scene, rays, {1, 1, 1}, {}), lit_b = visible(b.scene, rays, {1, 1, 1}, {});
        for (size_t i = 0; i < rays.size(); ++i)
        {
            ASSERT_TRUE(of_a[i].slot == of_b[i].slot && of_a[i].t == of_b[i].t &&
                        of_a[i].barycentrics.x == of_b[i].barycentrics.x &&
                        of_a[i].barycentrics.y == of_b[i].barycentrics.y)
                << "ray " << i;
            ASSERT_EQ(lit_a[i].x, lit_b[i].x) << "ray " << i;
        }
    }
};

/// The slot that a ray meets first, gpu::kNone where none; nothing where single precision cannot decide.
std::optional<uint32_t> firstSlot(const gpu::Ray& ray, std::span<const gpu::BvhTriangle> triangles)
{
    const std::vector<Meeting> met = meetings(ray, triangles);
    const auto nearest = std::ranges::min_element(met, {}, &Meeting::t);
    for (const Meeting& m : met)
        if (!m.certain || (m.slot != nearest->slot && m.t - m.t_error <= nearest->t + nearest->t_error))
            return std::nullopt;
    return met.empty() ? gpu::kNone : nearest->slot;
}

/// Whether they have the same corners but for a dozen roundings of numbers below 32.
bool alike(const gpu::BvhTriangle& a, const gpu::BvhTriangle& b)
{
    const std::array corners{a.v0, a.v1, a.v2}, others{b.v0, b.v1, b.v2};
    for (size_t turn = 0; turn < 3; ++turn)
    {
        double farthest = 0;
        for (size_t i = 0; i < 3; ++i)
            farthest = std::max(farthest, length(toDouble(corners[i]) - toDouble(others[(i + turn) % 3])));
        if (farthest < 12 * 32 * std::ldexp(1.0, -24))
            return true;
    }
    return false;
}

TEST_F(Hanging, BoxesThatChangePlacesAreHitAsInThePackageCompiledThen)
{
    const MovingScene source(swarmScene(200).glb());
    Shown hung(device(), source.package(), ObjectTree::kDrift), kept(device(), source.package(), kNever);
    const package::Package& package = hung.scene.package;
    std::vector<uint32_t> last = children(hung);
    const std::vector<uint32_t> first = last;
    uint32_t changes = 0;
    for (const double seconds : {0.0, 0.7, 1.0, 2.4, 4.0})
    {
        hung.at(seconds);
        kept.at(seconds);
        changes += children(hung) != last;
        last = children(hung);
        EXPECT_EQ(children(kept), first);

        const auto triangles = slots(hung);
        const auto rays =
            raysInto(triangles, package.firstMovingSlot(), {-20, 0.1f, -20}, {20, 9, 20}, 600, uint32_t(seconds * 10));
        expectSameHits(hung, kept, rays);

        const package::Package baked = open(source.bakedAt(seconds));
        ASSERT_EQ(baked.triangles().size(), package.triangles().size());
        const std::vector<gpu::Hit> found = closest(hung.scene, rays);
        uint32_t compared = 0, moving = 0;
        for (size_t i = 0; i < rays.size(); ++i)
        {
            const auto right = firstSlot(rays[i], baked.bvhTriangles());
            if (!right || !firstSlot(rays[i], triangles))
                continue;
            ++compared;
            const uint32_t slot = found[i].slot;
            ASSERT_EQ(slot == gpu::kNone, *right == gpu::kNone) << seconds << " ray " << i;
            if (slot != gpu::kNone)
            {
                ASSERT_TRUE(alike(triangles[slot], baked.bvhTriangles()[*right])) << seconds << " ray " << i;
            }
            moving += slot != gpu::kNone && slot >= package.firstMovingSlot();
        }
        EXPECT_GT(compared, 400u);
        EXPECT_GT(moving, 200u);
    }
    EXPECT_GE(changes, 3u); // at 0.7 or 1, at 2.4, and at 4, where it is as at rest
}

TEST_F(Hanging, AllocatesNothingOnceItHasHappened)
{
    const MovingScene source(swarmScene(2000).glb());
    Shown hung(device(), source.package(), ObjectTree::kDrift);
    hung.at(0);
    hung.at(1);
    const uint64_t allocations = device().allocationCount();
    for (const double seconds : {1.01, 1.5, 2.0, 3.5, 0.0})
        hung.at(seconds);
    EXPECT_EQ(device().allocationCount(), allocations);
}

TEST(ObjectBoundsAtAPose, EncloseWhatIsThere)
{
    const MovingScene source;
    const package::Package package = open(source.package());
    ObjectBounds bounds(package);
    for (const double seconds : {0.0, 0.37, 0.8, 1.5, 2.0})
    {
        const package::Pose pose = package::poseAt(package, 0, seconds);
        const std::vector<Vec3d> vertices = movedVertices(package, pose);
        const auto boxes = bounds.at(pose);
        ASSERT_EQ(boxes.size(), package.movingRanges().size());
        size_t hidden = 0;
        for (size_t i = 0; i < boxes.size(); ++i)
        {
            const package::MovingRange& range = package.movingRanges()[i];
            std::array<double, 3> low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
            for (uint32_t v = 0; v < range.vertex_count; ++v)
            {
                const Vec3d& p = vertices[range.first_vertex - package.firstMovingVertex() + v];
                for (const auto& [axis, x] : {std::pair{0, p.x}, {1, p.y}, {2, p.z}})
                {
                    low[size_t(axis)] = std::min(low[size_t(axis)], x);
                    high[size_t(axis)] = std::max(high[size_t(axis)], x);
                }
            }
            if (boxes[i].isEmpty())
            {
                ++hidden;
                EXPECT_EQ(high[0] - low[0], 0) << seconds << " " << i;
                continue;
            }
            for (size_t axis = 0; axis < 3; ++axis)
            {
                // A dozen roundings of numbers below 4, as in the kernel.
                const double error = 12 * 4 * std::ldexp(1.0, -24);
                EXPECT_LE(boxes[i].low[axis], low[axis] + error) << seconds << " " << i;
                EXPECT_GE(boxes[i].high[axis], high[axis] - error) << seconds << " " << i;
                if (seconds == 0) // nothing is turned, bent or bulged
                {
                    EXPECT_GE(boxes[i].low[axis], low[axis] - error) << i;
                    EXPECT_LE(boxes[i].high[axis], high[axis] + error) << i;
                }
            }
        }
        EXPECT_EQ(hidden, seconds < 1 ? 0u : 1u);
    }
}
} // namespace
